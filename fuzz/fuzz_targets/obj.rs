#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("obj"), |data: &[u8]| nephroid_fuzz::obj(data));
