#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("ply"), |data: &[u8]| nephroid_fuzz::ply(data));
