#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("photometry"), |data: &[u8]| nephroid_fuzz::photometry(data));
