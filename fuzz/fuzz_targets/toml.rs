#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("toml"), |data: &[u8]| nephroid_fuzz::toml(data));
