"""blender_read.py - runs inside Blender: writes what Blender reads in files, as JSON.

    blender -b --factory-startup -P blender_read.py -- OUT FILE...

For each file OUT has the corners, or the words with which Blender refused it. A corner is
[position, uv, normal, colour, material], with null for what the file has not; faces are lists of
corners. Blender makes z the upward axis of a glTF; that is reversed here.
"""
import json
import sys

import bpy
import numpy

# The glTF reader of Blender 3.4 uses a name that the numpy of Debian 12 no longer has.
numpy.bool = bool

READ = {
    'obj': lambda path: bpy.ops.wm.obj_import(filepath=path, forward_axis='Y', up_axis='Z'),
    'ply': lambda path: bpy.ops.import_mesh.ply(filepath=path),
    'stl': lambda path: bpy.ops.import_mesh.stl(filepath=path),
    'glb': lambda path: bpy.ops.import_scene.gltf(filepath=path),
}


def color_of(mesh, loop, kind):
    """Returns a colour as sRGB: glTF has linear colours; in other files the stored values are sRGB.
    """
    colors = mesh.color_attributes.active_color
    if colors is None:
        return None
    item = colors.data[loop.vertex_index if colors.domain == 'POINT' else loop.index]
    return list(item.color if kind == 'glb' else item.color_srgb)[:3]


def faces_of(thing, kind):
    mesh = thing.data
    mesh.calc_normals_split()
    uv = mesh.uv_layers.active
    for polygon in mesh.polygons:
        names = [m.name if m else None for m in mesh.materials]
        material = names[polygon.material_index] if polygon.material_index < len(names) else None
        face = []
        for i in polygon.loop_indices:
            loop = mesh.loops[i]
            place = thing.matrix_world @ mesh.vertices[loop.vertex_index].co
            normal = thing.matrix_world.to_3x3() @ loop.normal if mesh.has_custom_normals else None
            if kind == 'glb':
                place = (place[0], place[2], -place[1])
                normal = normal and (normal[0], normal[2], -normal[1])
            face.append([list(place), list(uv.data[i].uv) if uv else None,
                         list(normal) if normal else None, color_of(mesh, loop, kind), material])
        yield face


def read(path):
    kind = path.rsplit('.', 1)[1]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    READ[kind](path)
    return [face for thing in bpy.data.objects if thing.type == 'MESH'
            for face in faces_of(thing, kind)]


def main():
    out, *paths = sys.argv[sys.argv.index('--') + 1:]
    found = {}
    for path in paths:
        try:
            found[path] = read(path)
        except RuntimeError as why:
            found[path] = str(why)
    with open(out, 'w') as f:
        json.dump(found, f)


main()
