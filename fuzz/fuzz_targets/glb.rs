#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("glb"), |data: &[u8]| nephroid_fuzz::glb(data));
