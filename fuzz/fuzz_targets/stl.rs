#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("stl"), |data: &[u8]| nephroid_fuzz::stl(data));
