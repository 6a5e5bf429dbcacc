#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("mitsuba"), |data: &[u8]| nephroid_fuzz::mitsuba(data));
