#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("pbrt"), |data: &[u8]| nephroid_fuzz::pbrt(data));
