//! What is written reads back as what it was.
#![allow(clippy::unwrap_used)] // a test may

use std::path::Path;

use nephroid_scenefile::desc::*;
use nephroid_scenefile::{SceneDesc, Sourced, parse, to_toml};

/// A stream of numbers for making up scenes (SplitMix64, Steele et al. 2014).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn coin(&mut self) -> bool {
        self.below(2) == 1
    }

    /// Any finite number of 32 bits, often a plain one.
    fn number(&mut self) -> f32 {
        match self.below(4) {
            0 => self.below(9) as f32 - 4.0,
            1 => (self.below(2000) as f32 - 1000.0) / 100.0,
            _ => {
                let x = f32::from_bits(self.next() as u32);
                if x.is_finite() { x } else { 0.5 }
            }
        }
    }

    fn modest(&mut self) -> f32 {
        (self.below(1 << 24) as f32 / (1 << 23) as f32 - 1.0) * 10.0
    }

    fn unit(&mut self) -> f32 {
        match self.below(4) {
            0 => 0.5,
            1 => 1.0,
            _ => self.below((1 << 24) + 1) as f32 / (1 << 24) as f32,
        }
    }

    fn positive(&mut self) -> f32 {
        let x = self.number().abs();
        if x > 0.0 { x } else { 1.0 }
    }

    fn triple(&mut self) -> Triple {
        [self.number(), self.number(), self.number()]
    }

    /// Neither zero nor so large that its square overflows a check.
    fn direction(&mut self) -> Triple {
        [self.modest(), self.modest(), 11.0 + self.modest()]
    }

    fn amount(&mut self) -> Triple {
        if self.coin() { [1.0; 3] } else { [self.number().abs(), self.positive(), self.number().abs()] }
    }

    fn color(&mut self) -> ColorDesc {
        match self.below(3) {
            0 => ColorDesc::texture("te\"x\n"),
            1 => self.unit().into(),
            _ => [self.unit(), self.unit(), self.unit()].into(),
        }
    }

    fn float(&mut self) -> FloatDesc {
        if self.coin() { FloatDesc::texture("plain") } else { self.unit().into() }
    }

    fn ior(&mut self) -> Ior {
        if self.coin() { "N-BK7".into() } else { (1.0 + self.unit()).into() }
    }

    fn name(&mut self) -> Option<String> {
        let number = self.next();
        self.coin().then(|| format!("Ä.{number} \t'\u{7f}"))
    }

    fn roughness(&mut self) -> Roughness {
        match self.below(3) {
            0 => self.float().into(),
            1 => {
                Roughness::Perceived { roughness: self.float(), anisotropy: (self.unit() * 2.0 - 1.0).into() }
            }
            _ => Roughness::Alpha { along: self.float(), across: self.float() },
        }
    }

    fn facets(&mut self) -> Facets {
        [Facets::Conserving, Facets::SingleBounce, Facets::Separable, Facets::Beckmann]
            [self.below(4) as usize]
    }

    fn film(&mut self) -> ThinFilm {
        ThinFilm { thickness_nm: self.unit() * 4000.0, ior: 1.0 + self.unit() }
    }

    fn metal(&mut self) -> Metal {
        let (n, k) = ([self.positive(), self.positive(), 1.5], self.amount());
        if self.coin() { Metal::from("gold") } else { Metal::Index { n, k } }
    }

    fn kind(&mut self) -> MaterialKind {
        match self.below(14) {
            0 => MaterialKind::Diffuse { color: self.color() },
            1 => {
                let (diffuse, exponent) = (self.unit() * 0.5, self.positive().min(1e6));
                MaterialKind::Phong {
                    diffuse: diffuse.into(),
                    specular: 0.5.into(),
                    exponent: exponent.into(),
                }
            }
            2 => MaterialKind::Mirror { color: self.color() },
            3 => MaterialKind::Dielectric(Dielectric {
                ior: self.ior(),
                outside_ior: (self.below(2) == 0).then(|| 1.0 + self.unit()),
                color: self.color(),
                specular: self.color(),
                roughness: self.roughness(),
                facets: self.facets(),
                film: self.film(),
                absorption: self.amount(),
                priority: self.next() as i32,
            }),
            4 => MaterialKind::Conductor(Conductor {
                metal: self.metal(),
                specular: self.color(),
                roughness: self.roughness(),
                facets: self.facets(),
                film: self.film(),
            }),
            5 => MaterialKind::RoughDiffuse { color: self.color(), roughness: self.float() },
            6 => MaterialKind::DiffuseTransmission {
                reflectance: (self.unit() * 0.5).into(),
                transmittance: self.color_of(0.5),
            },
            7 => MaterialKind::Sheen { color: self.color(), roughness: self.float() },
            8 => MaterialKind::ThinDielectric(ThinDielectric {
                ior: self.ior(),
                color: self.color(),
                specular: self.color(),
                roughness: self.roughness(),
            }),
            9 => MaterialKind::CoatedDiffuse(CoatedDiffuse {
                color: self.color(),
                specular: self.color(),
                ior: self.ior(),
                roughness: self.roughness(),
                facets: self.facets(),
                nonlinear: self.coin(),
                depth: self.unit() * 9.0,
            }),
            10 => MaterialKind::CoatedConductor(CoatedConductor {
                metal: self.metal(),
                roughness: self.roughness(),
                ior: self.ior(),
                coat_roughness: self.float(),
                depth: self.unit(),
                facets: self.facets(),
            }),
            12 => MaterialKind::Mix {
                a: Material::diffuse(self.color()).into(),
                b: Material::from(MaterialKind::Sheen { color: self.color(), roughness: self.float() })
                    .into(),
                amount: self.float(),
            },
            11 => MaterialKind::Principled(Box::new(self.principled())),
            _ => MaterialKind::Plastic { color: self.color(), ior: self.ior(), roughness: self.roughness() },
        }
    }

    fn principled(&mut self) -> Principled {
        Principled {
            base_color: self.color(),
            metallic: self.float(),
            roughness: self.roughness(),
            ior: self.ior(),
            specular: self.float(),
            specular_color: self.color(),
            transmission: self.float(),
            thin: self.coin(),
            diffuse_transmission: self.float(),
            sheen_color: self.color(),
            sheen_roughness: self.float(),
            clearcoat: self.float(),
            clearcoat_roughness: self.float(),
            film: self.float(),
            film_thickness_nm: (self.unit() * 4000.0).into(),
            film_ior: 1.0 + self.unit(),
            absorption: self.amount(),
            priority: self.next() as i32,
        }
    }

    /// A colour of at most `most`.
    fn color_of(&mut self, most: f32) -> ColorDesc {
        if self.coin() { ColorDesc::texture("plain") } else { (self.unit() * most).into() }
    }

    fn material(&mut self) -> Material {
        let kind = self.kind();
        Material {
            opacity: self.float(),
            opacity_cutoff: self.coin().then(|| self.unit()),
            normal_map: self.coin().then(|| "plain".into()),
            normal_strength: self.unit() * 2.0,
            bump_map: self.coin().then(|| "plain".into()),
            bump_height: self.unit(),
            rotation: self.float(),
            two_sided: !kind.has_two_sided() || self.coin(),
            kind,
        }
    }

    fn material_ref(&mut self) -> MaterialRef {
        if self.coin() { "m 1".into() } else { self.material().into() }
    }

    fn steps(&mut self) -> TransformSteps {
        let step = |dice: &mut Self| match dice.below(5) {
            0 => TransformStep::Translate(dice.triple()),
            1 => TransformStep::Rotate { axis: dice.direction(), degrees: dice.number() },
            2 => TransformStep::Scale(dice.direction().map(|x| if x == 0.0 { 1.0 } else { x })),
            3 => TransformStep::LookAt { position: [0.0; 3], target: dice.direction(), up: [0.0, 1e3, 1e-3] },
            _ => {
                let mut m = [0.0; 16];
                for (i, x) in m.iter_mut().take(12).enumerate() {
                    *x = if i % 5 == 0 { 3.0 + dice.unit() } else { dice.unit() };
                }
                m[15] = 1.0;
                TransformStep::Matrix(m)
            }
        };
        (0..self.below(4)).map(|_| step(self)).collect()
    }

    fn normals(&mut self) -> Normals {
        match self.below(5) {
            4 => Normals::Completed,
            0 => Normals::Given,
            1 => Normals::Flat,
            2 => Normals::Smooth { crease_degrees: 180.0 },
            _ => Normals::Smooth { crease_degrees: self.unit() * 90.0 },
        }
    }

    fn shape(&mut self) -> Shape {
        let (center, radius) = (self.triple(), self.positive());
        let (axis, segments) = (self.direction(), 3 + self.below(200) as u32);
        let tube_segments = 3 + self.below(200) as u32;
        match self.below(22) {
            0 => Shape::Sphere { center, radius },
            1 => Shape::Disk { center, normal: axis, radius },
            2 => Shape::Quad { origin: center, edge_u: axis, edge_v: [30.0, self.modest(), 0.0] },
            3 => Shape::Corners { corners: [[0.0; 3], [9.0, 0.0, 0.0], axis, [0.0, 9.0, self.modest()]] },
            4 => Shape::Mesh { file: "cöw \"1\".ply".into(), normals: self.normals() },
            5 => {
                let full = self.coin();
                Shape::Triangles {
                    positions: vec![[0.0; 3], [9.0, 0.0, 0.0], axis, [-9.0, 7.5, 1e-12]],
                    indices: vec![[0, 1, 2], [0, 2, 3]],
                    vertex_normals: if full { vec![center; 4] } else { vec![] },
                    uvs: if full { vec![] } else { vec![[self.number(), self.number()]; 4] },
                    uvs2: if self.coin() { vec![] } else { vec![[self.number(), self.number()]; 4] },
                    colors: if self.coin() { vec![] } else { vec![[0.5, 0.25, self.unit(), self.unit()]; 4] },
                    normals: self.normals(),
                }
            }
            6 => Shape::Box { min: [-3.0, -20.0, -1e-3], max: axis.map(|x| x + 10.5) },
            7 => {
                let mask = 1 + self.below(31);
                let solid = self.coin();
                // A solid is all of it.
                let part = |i: &usize| solid || mask >> i & 1 == 1;
                let parts = (0..5).filter(part).map(|i| TEAPOT_PARTS[i]).collect();
                Shape::Teapot { level: 1 + self.below(256) as u32, parts, solid }
            }
            8 => Shape::Lathe {
                profile: vec![[0.0, 0.0], [radius, self.modest()], [1.0, 3.5]],
                segments,
                smooth: self.coin(),
                closed: self.coin(),
                steps: 1 + self.below(16) as u32,
                crease_degrees: self.unit() * 180.0,
            },
            11 => Shape::Ring { segments },
            12 => Shape::CoffeeCup { segments },
            13 => Shape::WineGlass { segments },
            14 => Shape::Wine { segments },
            15 => Shape::Band {
                inner_radius: 0.5 + self.unit(),
                outer_radius: 2.0,
                height: self.positive(),
                fillet: self.unit(),
                segments,
            },
            9 => Shape::Cylinder {
                base: center,
                axis,
                radius,
                height: self.positive(),
                inward: self.coin(),
                closed: self.coin(),
                segments,
            },
            16 => Shape::Cone {
                base: center,
                axis,
                radius,
                top_radius: self.unit(),
                height: self.positive(),
                closed: self.coin(),
                segments,
            },
            17 => Shape::Capsule { base: center, axis, radius, height: self.positive(), segments },
            18 => Shape::RoundedBox {
                min: [-1.0, -2.0, -3.5],
                max: [1.0, 2.0, 3.0 + self.unit()],
                radius: 0.25 + self.unit() * 0.5,
                steps: 1 + self.below(64) as u32,
            },
            19 => Shape::RoundBrilliant(Brilliant {
                center,
                axis,
                diameter: radius,
                table: 0.25 + 0.5 * self.unit(),
                crown_degrees: 10.0 + 30.0 * self.unit(),
                pavilion_degrees: 10.0 + 30.0 * self.unit(),
                girdle: 0.01 + 0.1 * self.unit(),
                star_length: 0.25 + 0.5 * self.unit(),
                lower_half_length: 0.25 + 0.5 * self.unit(),
                culet: 0.5 * self.unit(),
            }),
            21 => Shape::HeightField(HeightField {
                center,
                size: [radius, self.positive()],
                source: HeightSource::Rows(vec![
                    vec![self.number(), self.number()],
                    vec![0.0, self.number()],
                ]),
                height: self.number(),
                depth: self.coin().then(|| self.positive()),
            }),
            20 => Shape::WaterSurface(WaterSurface {
                center,
                size: [radius, self.positive()],
                depth: self.coin().then(|| self.positive()),
                resolution: 8 + self.below(4089) as u32,
                wind_speed: 1.0 + self.unit(),
                wind_degrees: self.number(),
                fetch: self.positive(),
                wave_height: self.coin().then(|| self.unit()),
                waves: 1 + self.below(256) as u32,
                seed: self.next() as u32,
                time: self.number(),
            }),
            10 => Shape::Torus {
                center,
                axis,
                major_radius: radius,
                minor_radius: 0.25,
                segments,
                tube_segments,
            },
            _ => Shape::Icosphere { center, radius, level: self.below(10) as u32, smooth: self.coin() },
        }
    }

    fn object(&mut self) -> Sourced<Object> {
        let color = self.amount().map(|x| x.min(1e3));
        let emission = match self.below(3) {
            0 => None,
            1 => Some(EmissionAmount::Radiance(self.amount())),
            _ => Some(EmissionAmount::Power { watts: self.unit() + 0.5, color }),
        };
        let material = if emission.is_none() || self.coin() { Some(self.material_ref()) } else { None };
        let light_group = if emission.is_some() { self.name() } else { None };
        Object {
            name: self.name(),
            shape: self.shape().into(),
            material,
            transform: self.steps(),
            displacement: self.coin().then(|| {
                let edge = if self.coin() { EdgeLength::Units(0.25) } else { EdgeLength::Pixels(1.5) };
                let scale = self.unit() - 0.5;
                Displacement { texture: "plain".to_owned().into(), scale, midlevel: self.unit(), edge }.into()
            }),
            flip_normals: self.coin(),
            emission: emission.map(|amount| {
                let texture = self.coin().then(|| "plain".to_owned().into());
                Emission { amount, texture, two_sided: self.coin() }.into()
            }),
            light_group,
        }
        .into()
    }

    fn light(&mut self) -> Sourced<Light> {
        let amount = if self.coin() {
            PointAmount::Intensity(self.amount())
        } else {
            PointAmount::Power { watts: 1.0 + self.unit(), color: self.amount().map(|x| x.min(1e3)) }
        };
        let position = self.triple();
        let picture = || ImageSource::from("wölk \"1\".hdr");
        let mapping = [SkyMapping::LatLong, SkyMapping::EqualArea][self.below(2) as usize];
        let kind = match self.below(9) {
            8 => {
                let color = self.amount().map(|x| x.clamp(1e-3, 1e3));
                let amount = if self.coin() {
                    ProfileAmount::AsFile { scale: self.positive(), color }
                } else {
                    ProfileAmount::Power { watts: 1.0 + self.unit(), color }
                };
                let file = Path::new("lämp.ies").to_path_buf().into();
                LightKind::Profile { file, transform: self.steps(), amount }
            }
            7 => LightKind::Goniometric {
                source: picture(),
                mapping,
                intensity: self.amount(),
                transform: self.steps(),
            },
            6 => LightKind::Projector {
                source: picture(),
                fov: 1.0 + 178.0 * self.unit(),
                intensity: self.amount(),
                transform: self.steps(),
            },
            5 => LightKind::SunSky(SunSky {
                sun_direction: self.direction(),
                turbidity: 1.0 + 9.0 * self.unit(),
                ground_albedo: [self.unit(), self.unit(), 0.25],
                sun_scale: self.unit(),
                sun_angle: 0.1 + self.unit(),
                sky_scale: self.unit(),
                transform: self.steps(),
            }),
            4 => LightKind::Sky {
                source: "wölk \"1\".hdr".into(),
                mapping: [SkyMapping::LatLong, SkyMapping::EqualArea][self.below(2) as usize],
                scale: self.amount(),
                transform: self.steps(),
            },
            0 => LightKind::Point { position, amount },
            1 => {
                let cone_angle = self.unit() * 179.0 + 1.0;
                let falloff_angle =
                    if self.coin() { 5.0f32.min(cone_angle) } else { self.unit() * cone_angle };
                LightKind::Spot { position, direction: self.direction(), cone_angle, falloff_angle, amount }
            }
            2 => LightKind::Directional { direction: self.direction(), irradiance: self.amount() },
            _ => LightKind::Environment { radiance: self.amount() },
        };
        Light { name: self.name(), light_group: self.name(), kind }.into()
    }

    fn mapping(&mut self) -> Mapping {
        let (scale, offset) = ([self.number(), self.number()], [self.number(), self.number()]);
        let scale = if self.coin() { [scale[0]; 2] } else { scale };
        if self.below(4) == 0 {
            return Mapping::Planar { u: self.triple(), v: self.triple(), offset };
        }
        let rotation = if self.coin() { 0.0 } else { self.number() };
        Mapping::Uv { set: self.below(2) as u8, scale, rotation, offset }
    }

    fn channel(&mut self) -> Channel {
        [Channel::Rgb, Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha][self.below(5) as usize]
    }

    fn wrap(&mut self) -> Wrap {
        [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror, Wrap::Black][self.below(4) as usize]
    }

    fn noise(&mut self) -> Noise {
        let kind = match self.below(4) {
            0 => NoiseKind::Fbm,
            1 => NoiseKind::Wrinkled,
            2 => NoiseKind::Windy,
            _ => NoiseKind::Marble { scale: self.number(), variation: self.number() },
        };
        let windy = kind == NoiseKind::Windy;
        Noise {
            kind,
            octaves: if windy { 8 } else { 1 + self.below(32) as u32 },
            roughness: if windy { 0.5 } else { self.unit() },
            transform: self.steps(),
        }
    }

    /// Made of textures that are called `parts`, or of colours.
    fn texture(&mut self, parts: &[&str]) -> Texture {
        let color = |dice: &mut Self| match parts {
            [first, ..] if dice.coin() => ColorDesc::texture(*first),
            _ => [dice.number(), dice.positive(), 0.0].into(),
        };
        match self.below(7) {
            0 => Texture::Checker { a: color(self), b: color(self), mapping: self.mapping() },
            1 => Texture::Dots { inside: color(self), outside: color(self), mapping: self.mapping() },
            2 => Texture::Product { a: color(self), b: color(self) },
            3 => {
                let amount = match parts {
                    [.., last] if self.coin() => FloatDesc::texture(*last),
                    _ => self.number().into(),
                };
                Texture::Mix { a: color(self), b: color(self), amount }
            }
            4 => Texture::Noise(self.noise()),
            5 => Texture::VertexColor { channel: self.channel() },
            _ => Texture::Image(Image {
                source: "pic\\ture.png".into(),
                color_space: if self.coin() { ColorSpace::Srgb } else { ColorSpace::Linear },
                wrap: [self.wrap(), self.wrap()],
                filter: [TextureFilter::Trilinear, TextureFilter::Bilinear, TextureFilter::Nearest]
                    [self.below(3) as usize],
                mapping: self.mapping(),
                channel: self.channel(),
                invert: self.coin(),
                factor: self.triple(),
            }),
        }
    }

    fn camera(&mut self) -> Camera {
        let mapping = if self.coin() { SkyMapping::LatLong } else { SkyMapping::EqualArea };
        let kind = match self.below(5) {
            3 => CameraKind::Orthographic { extent: self.positive() },
            4 => CameraKind::Spherical { mapping },
            0 => CameraKind::Pinhole,
            1 => CameraKind::ThinLens { lens_radius: self.positive(), focus_distance: None },
            _ => CameraKind::ThinLens { lens_radius: self.positive(), focus_distance: Some(self.positive()) },
        };
        let whole = Camera {
            kind,
            position: [0.0; 3],
            look_at: self.direction(),
            up: [0.0, 1e3, 1e-3],
            fov: 1.0 + self.unit() * 178.0,
            shift: [self.unit(), 0.0],
            fov_axis: [FovAxis::X, FovAxis::Y, FovAxis::Smaller][self.below(3) as usize],
        };
        // What the kind has no key for stays as it is.
        let Camera { fov, fov_axis, shift, .. } = Camera::default();
        match kind {
            CameraKind::Spherical { .. } => Camera { fov, fov_axis, shift, ..whole },
            CameraKind::Orthographic { .. } => Camera { fov, ..whole },
            CameraKind::Pinhole | CameraKind::ThinLens { .. } => whole,
        }
    }

    fn scene(&mut self, base: &Path) -> SceneDesc {
        let kernels = [PhotonFilter::Constant, PhotonFilter::Cone, PhotonFilter::Epanechnikov];
        let filters =
            [FilterKind::Box, FilterKind::Gaussian, FilterKind::Mitchell, FilterKind::BlackmanHarris];
        let mut desc = SceneDesc { base: base.into(), ..SceneDesc::default() };
        if self.coin() {
            desc.render = Render {
                integrator: if self.coin() { IntegratorKind::Path } else { IntegratorKind::PhotonMap },
                passes: 1 + self.below(1_000_000_000) as u32,
                seed: self.next(),
                max_depth: self.coin().then(|| 1 + self.below(u32::MAX as u64) as u32),
                noise: self.coin().then(|| 0.001 + 0.9 * self.unit()),
            };
            desc.film = Film {
                size: [1 + self.below(20_000) as u32, 1 + self.below(20_000) as u32],
                crop: self.coin().then_some([0, 0, 1, 1]),
                filter: filters[self.below(4) as usize],
                filter_radius: self.coin().then(|| self.unit() + 0.25),
                exposure: if self.coin() { Exposure::Auto } else { Exposure::Ev(self.modest()) },
                white_balance: match self.below(4) {
                    0 => WhiteBalance::None,
                    1 => WhiteBalance::Auto,
                    2 => WhiteBalance::Kelvin(1000.0 + self.unit() * 30000.0),
                    _ => WhiteBalance::from_text("F11").unwrap(),
                },
                view: View::ALL[self.below(5) as usize],
                lut: self.coin().then(|| Sourced::from(std::path::PathBuf::from("look s.cube"))),
                denoise: if self.coin() { Denoise::Require } else { Denoise::Auto },
                layers: Layers { techniques: self.coin(), lights: self.coin() },
            };
            desc.photon_map = PhotonMap {
                photons: self.below(1_000_000_001),
                caustic_photons: self.below(1_000_000_001),
                knn: 2 + self.below(1000) as u32,
                caustic_knn: 2 + self.below(1000) as u32,
                filter: kernels[self.below(3) as usize],
                caustic_filter: kernels[self.below(3) as usize],
                radius: self.coin().then(|| self.positive()),
                caustic_radius: self.coin().then(|| self.positive()),
                final_gather: self.below(65_537) as u32,
                caustic_gain: self.number().abs(),
            };
        }
        desc.camera = Some(self.camera().into());
        let plain = self.texture(&[]);
        desc.textures.insert("plain".into(), plain.into());
        let other = self.texture(&["plain"]);
        desc.textures.insert("te\"x\n".into(), other.into());
        let made = self.texture(&["te\"x\n", "plain"]);
        desc.textures.insert("made".into(), made.into());
        for i in 0..1 + self.below(4) {
            desc.materials.insert(format!("m {}", i + 1), self.material().into());
        }
        desc.objects = (0..self.below(5)).map(|_| self.object()).collect();
        desc.lights = (0..self.below(3)).map(|_| self.light()).collect();
        desc.groups.insert(
            "Gruppe.1".into(),
            Group { objects: (0..self.below(3)).map(|_| self.object()).collect() }.into(),
        );
        desc.instances = (0..self.below(3))
            .map(|_| {
                let material = self.coin().then(|| self.material_ref());
                let group = "Gruppe.1".into();
                Instance { name: self.name(), group, transform: self.steps(), material }.into()
            })
            .collect();
        desc
    }
}

#[test]
fn scenes_read_back_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    for file in ["pic\\ture.png", "cöw \"1\".ply", "wölk \"1\".hdr", "lämp.ies"] {
        std::fs::write(folder.path().join(file), "").unwrap();
    }
    let path = folder.path().join("scene.toml");
    let mut dice = Dice(7);
    for _ in 0..400 {
        let desc = dice.scene(folder.path());
        let text = to_toml(&desc);
        let loaded = parse(&text, &path, &[]);
        let read = loaded.desc.clone().unwrap_or_else(|| panic!("{text}\n{}", loaded.render()));
        assert!(read == desc, "{text}\n{read:#?}\n{desc:#?}");
        assert_eq!(to_toml(&read), text);
        assert!(nephroid_scenefile::check(&read).iter().all(|d| !d.is_error()));
    }
}

#[test]
fn numbers_keep_every_bit() {
    let mut dice = Dice(11);
    let mut desc = SceneDesc::default();
    for _ in 0..200 {
        let all: Vec<Triple> = (0..100).map(|_| dice.triple()).collect();
        let shape = Shape::Triangles {
            positions: all.clone(),
            indices: vec![[0, 1, 2]],
            vertex_normals: vec![],
            uvs: vec![],
            uvs2: vec![],
            colors: vec![],
            normals: Normals::Given,
        };
        desc.objects = vec![Object::lamp(shape, Emission::power(1.0)).into()];
        desc.camera = Some(Camera::default().into());
        let loaded = parse(&to_toml(&desc), Path::new("x.toml"), &[]);
        let Some(read) = &loaded.desc else {
            // A first triangle of extreme numbers has no area that can be told.
            assert!(loaded.diagnostics.iter().all(|d| d.code == "degenerate"), "{}", loaded.render());
            continue;
        };
        let Shape::Triangles { positions, .. } = &read.objects[0].shape.value else { panic!() };
        let bits = |all: &[Triple]| all.iter().flat_map(|p| p.map(f32::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(positions), bits(&all));
    }
}

#[test]
fn an_empty_description_is_an_empty_text() {
    assert_eq!(to_toml(&SceneDesc::default()), "");
}
