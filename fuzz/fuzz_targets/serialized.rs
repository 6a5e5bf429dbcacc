#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("serialized"), |data: &[u8]| nephroid_fuzz::serialized(data));
