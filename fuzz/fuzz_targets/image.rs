#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("image"), |data: &[u8]| nephroid_fuzz::image(data));
