#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("spd"), |data: &[u8]| nephroid_fuzz::spd(data));
