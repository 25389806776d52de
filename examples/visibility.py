#!/usr/bin/env python3
"""The visibility of a shot's first light as a numpy array, against ray-traced truth, through the C library.

    HALFSHADE_LIBRARY=target/release/libhalfshade.so examples/visibility.py scenes/plate.json --size 64
"""

import argparse
import ctypes as c
import os

import numpy as np

TYPE_CAMERA, TYPE_SHOT_COUNTS, TYPE_REFERENCE_INFO = 7, 10, 14


def structure(kind, fields):
    """A structure of the interface: a head of type, size and next, then its fields."""

    class Structure(c.Structure):
        _fields_ = [("type", c.c_uint32), ("size", c.c_uint32), ("next", c.c_void_p), *fields]

        def __init__(self, **values):
            super().__init__(type=kind, size=c.sizeof(type(self)), **values)

    return Structure


Camera = structure(TYPE_CAMERA, [
    ("eye", c.c_double * 3), ("target", c.c_double * 3), ("up", c.c_double * 3), ("vfov_deg", c.c_double),
    ("width", c.c_uint32), ("height", c.c_uint32)])
ShotCounts = structure(TYPE_SHOT_COUNTS, [
    ("width", c.c_uint32), ("height", c.c_uint32), ("lights", c.c_uint32), ("reserved", c.c_uint32)])
ReferenceInfo = structure(TYPE_REFERENCE_INFO, [("light", c.c_uint32), ("samples", c.c_uint32), ("seed", c.c_uint64)])


class Library:
    """The functions that this example uses; a result other than HS_OK becomes an exception with its sentence."""

    def __init__(self, path):
        self.raw = c.CDLL(path)
        if self.raw.hs_abi_version() != 1:
            raise SystemExit(f"{path} has another binary interface than this script")
        handle, place, floats = c.c_void_p, c.POINTER(c.c_void_p), c.POINTER(c.c_float)
        self.raw.hs_last_error.restype = c.c_uint64
        self.raw.hs_last_error.argtypes = [handle, c.c_char_p, c.c_uint64]
        for name, arguments in {
            "hs_context_create": [c.c_void_p, place],
            "hs_shot_load": [handle, c.c_char_p, place],
            "hs_shot_describe": [handle, c.POINTER(ShotCounts)],
            "hs_shot_set_camera": [handle, c.POINTER(Camera)],
            "hs_renderer_create": [handle, c.c_void_p, place],
            "hs_renderer_render": [handle],
            "hs_renderer_visibility": [handle, c.c_uint32, floats, c.c_uint64],
            "hs_reference": [handle, c.POINTER(ReferenceInfo), floats, floats, floats, c.c_uint64],
        }.items():
            getattr(self.raw, name).argtypes = arguments
        for name in "context", "shot", "renderer":
            getattr(self.raw, f"hs_{name}_destroy").argtypes = [handle]

    def call(self, name, *arguments):
        if getattr(self.raw, name)(*arguments) != 0:
            text = c.create_string_buffer(1024)
            self.raw.hs_last_error(None, text, len(text))
            raise RuntimeError(f"{name}: {text.value.decode()}")

    def create(self, name, *arguments):
        made = c.c_void_p()
        self.call(name, *arguments, c.byref(made))
        return made


def floats_of(array):
    return array.ctypes.data_as(c.POINTER(c.c_float))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shot")
    parser.add_argument("--size", type=int, help="width and height in pixels, seen from above the origin")
    parser.add_argument("--samples", type=int, default=256, help="rays a pixel of the truth")
    parser.add_argument("--save", help="file for the visibility, .npy")
    args = parser.parse_args()
    library = Library(os.environ.get("HALFSHADE_LIBRARY", "libhalfshade.so.1"))
    context = library.create("hs_context_create", None)
    shot = library.create("hs_shot_load", context, args.shot.encode())
    if args.size:
        camera = Camera(eye=(0, 5, 3), target=(0, 0, 0), up=(0, 1, 0), vfov_deg=40, width=args.size, height=args.size)
        library.call("hs_shot_set_camera", shot, c.byref(camera))
    counts = ShotCounts()
    library.call("hs_shot_describe", shot, c.byref(counts))
    visibility = np.empty((counts.height, counts.width), np.float32)
    truth = np.empty_like(visibility)
    renderer = library.create("hs_renderer_create", shot, None)
    library.call("hs_renderer_render", renderer)
    library.call("hs_renderer_visibility", renderer, 0, floats_of(visibility), visibility.size)
    info = ReferenceInfo(light=0, samples=args.samples, seed=0)
    library.call("hs_reference", shot, c.byref(info), floats_of(truth), None, None, truth.size)
    error = np.abs(visibility - truth)
    print(f"{counts.width}x{counts.height} pixels, {np.isnan(truth).mean():.0%} without a surface: "
          f"mean visibility {np.nanmean(visibility):.4f}, mean error {np.nanmean(error):.5f} against {args.samples} rays")
    if args.save:
        np.save(args.save, visibility)
    for name, made in ("renderer", renderer), ("shot", shot), ("context", context):
        getattr(library.raw, f"hs_{name}_destroy")(made)


if __name__ == "__main__":
    main()
