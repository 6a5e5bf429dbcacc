#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("checkpoint"), |data: &[u8]| nephroid_fuzz::checkpoint(data));
