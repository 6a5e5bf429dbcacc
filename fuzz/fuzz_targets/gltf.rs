#![no_main]
libfuzzer_sys::fuzz_target!(init: nephroid_fuzz::seeds::write("gltf"), |data: &[u8]| nephroid_fuzz::gltf(data));
