#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("mtl"), |data: &[u8]| nephroid_fuzz::mtl(data));
