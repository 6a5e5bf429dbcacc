#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("compile"), |data: &[u8]| nephroid_fuzz::compile(data));
