#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("film"), |data: &[u8]| nephroid_fuzz::film(data));
