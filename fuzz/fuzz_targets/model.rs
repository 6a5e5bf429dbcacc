#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("model"), |data: &[u8]| nephroid_fuzz::model(data));
