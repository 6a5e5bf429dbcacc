#!/usr/bin/env python3
"""The peer of `paths`: Mitsuba 3's path tracer on a scene file of ours, driven line by line.

    mitsuba_paths.py SCENE.toml VARIANT

says "ready VERSION", then reads lines "SPP DEPTH ROULETTE SEED" and answers each with "CPU_SECONDS R G B": the processor time
(user + system, all threads) of one render of SPP samples a pixel, scene and kernels ready, and the mean of its pixels.
DEPTH counts scattering events, -1 is no limit; Russian roulette begins after ROULETTE of them.

Of scene files it knows what `arena/box.toml` has: quads of four corners and triangles, diffuse materials, surfaces
that emit, the pinhole camera, the box filter.
"""

import resource
import sys
import tomllib


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def mesh(mi, name, shape, materials):
    """A mesh with the object's material and emission."""
    if shape["shape"] == "quad":
        positions, indices = shape["corners"], [[0, 1, 2], [0, 2, 3]]
    elif shape["shape"] == "triangles":
        positions, indices = shape["positions"], shape["indices"]
    else:
        raise SystemExit(f"{name}: the peer's script knows no {shape['shape']}")
    properties = mi.Properties()
    color = materials.get(shape.get("material"), [0, 0, 0])
    bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": color}}
    properties["bsdf"] = mi.load_dict({"type": "twosided", "bsdf": bsdf} if any(color) else bsdf)
    if "radiance" in shape:
        emitter = {"type": "area", "radiance": {"type": "rgb", "value": shape["radiance"]}}
        properties["emitter"] = mi.load_dict(emitter)
    properties["face_normals"] = True
    built = mi.Mesh(name, len(positions), len(indices), props=properties)
    parameters = mi.traverse(built)
    parameters["vertex_positions"] = [x for p in positions for x in p]
    parameters["faces"] = [i for t in indices for i in t]
    parameters.update()
    return built


def scene(mi, text):
    description = tomllib.loads(text)
    width, height = description["film"]["size"]
    camera = description["camera"]
    view = mi.ScalarTransform4f().look_at(camera["position"], camera["look_at"], camera.get("up", [0, 1, 0]))
    film = {
        "type": "hdrfilm",
        "width": width,
        "height": height,
        "pixel_format": "rgb",
        "component_format": "float32",
        "filter": {"type": description["film"]["filter"]},
    }
    parts = {
        "type": "scene",
        "camera": {
            "type": "perspective",
            "fov": camera["fov"],
            "fov_axis": "smaller",
            "to_world": view,
            "film": film,
            "sampler": {"type": "independent"},
        },
    }
    materials = {name: m["color"] for name, m in description["materials"].items()}
    for number, shape in enumerate(description["objects"]):
        parts[f"object{number}"] = mesh(mi, f"object{number}", shape, materials)
    return mi.load_dict(parts)


def main():
    path, variant = sys.argv[1:]
    import drjit
    import mitsuba as mi

    mi.set_variant(variant)
    drjit.set_thread_count(1)
    with open(path) as file:
        world = scene(mi, file.read())
    print("ready", mi.__version__, flush=True)
    integrators = {}
    for line in sys.stdin:
        spp, depth, roulette, seed = map(int, line.split())
        # Mitsuba's depth counts the edges of a path: 1 is a lamp that the camera sees.
        settings = {"type": "path", "max_depth": depth + 1 if depth >= 0 else -1, "rr_depth": roulette}
        key = (depth, roulette)
        integrator = integrators.setdefault(key, mi.load_dict(settings))
        start = cpu_seconds()
        pixels = mi.render(world, integrator=integrator, spp=spp, seed=seed).numpy()
        seconds = cpu_seconds() - start
        print(seconds, *pixels.mean(axis=(0, 1), dtype="float64"), flush=True)


if __name__ == "__main__":
    main()
