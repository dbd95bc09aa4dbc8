// shaders.js - the GLSL programs. They read the arrays of geometry.js from two textures at indices
// made from gl_VertexID, so the arrays need not be repeated in vertex buffers.

import { CUT_FRAGMENT, CUT_VERTEX, LOOK_FRAGMENT, LOOK_VERTEX } from './look_shaders.js';
import { VALUE_FRAGMENT, VALUE_VERTEX } from './value_shader.js';

const TEXTURES = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform sampler2D vertices;
uniform usampler2D triangles;

ivec2 texel(int index, int width) {
    return ivec2(index % width, index / width);
}
vec4 vertexAt(int slot) {
    return texelFetch(vertices, texel(slot, textureSize(vertices, 0).x), 0);
}
uvec4 triangleAt(int index) {
    return texelFetch(triangles, texel(index, textureSize(triangles, 0).x), 0);
}
`;

// The vertex shader of faces, which runs for each corner of a triangle. `bary` are barycentric
// coordinates. Normals are computed from derivatives in the fragment shader: a vertex shader would
// have to fetch all three corners in each of its three runs.
export const SURFACE_VERTEX = `${TEXTURES}${VALUE_VERTEX}
uniform usampler2D labels;
uniform sampler2D palette;
uniform bool isColored;
flat out uint triangle;
flat out uint sides;
flat out vec4 base;
flat out vec4 glow;
out vec3 bary;
out vec3 eye;
#ifdef LOOKED
${LOOK_VERTEX}
#endif

// Finds the material of a face, see materials.js.
void find(int face) {
    ivec2 place = texel(face / 4, textureSize(labels, 0).x);
    base = vec4(1.0);
    glow = vec4(0.0);
    if (isColored && place.y < textureSize(labels, 0).y) {
        int width = textureSize(palette, 0).x;
        int entry = 2 * int(texelFetch(labels, place, 0)[face % 4]);
        if (entry / width < textureSize(palette, 0).y) {
            base = texelFetch(palette, texel(entry, width), 0);
            glow = texelFetch(palette, texel(entry + 1, width), 0);
        }
    }
}

void main() {
    int index = gl_VertexID / 3;
    int corner = gl_VertexID - 3 * index;
    uvec4 words = triangleAt(index);
    vec3 place = vertexAt(int(words[corner])).xyz;
    vec4 seen = modelViewMatrix * vec4(place, 1.0);
    find(int(words.w & 0x1fffffffu));
#ifdef LOOKED
    lookAtCorner(index, corner, place);
#endif
    putValue(index, corner, words[corner], words.w & 0x1fffffffu);
    triangle = uint(index);
    sides = words.w >> 29;
    bary = vec3(corner == 0, corner == 1, corner == 2);
    eye = -seen.xyz;
    gl_Position = projectionMatrix * seen;
}
`;

// The fragment shader of faces, which draws fill and polygon edges in one pass; `chosen` says that
// the face is selected. If a face is translucent, a part of its pixels is discarded in a pattern,
// so that triangles need not be sorted. The back of a face with a one-sided material is drawn as if
// it had no material, because the face may be oriented wrongly.
export const SURFACE_FRAGMENT = `
precision highp float;
precision highp int;
${VALUE_FRAGMENT}
flat in uint sides;
flat in vec4 base;
flat in vec4 glow;
in vec3 bary;
in vec3 eye;
uniform bool chosen;
uniform float edgeWidth;
uniform float edgeStrength;
out vec4 color;
#ifdef LOOKED
${LOOK_FRAGMENT}
#endif

const vec3 FRONT = vec3(0.62, 0.68, 0.77);
const vec3 BACK = vec3(0.55, 0.42, 0.40);
const vec3 CHOSEN = vec3(0.98, 0.70, 0.28);
const vec3 EDGE = vec3(0.055, 0.070, 0.095);
const vec3 EDGE_IN_THE_DARK = vec3(0.36, 0.38, 0.42);
const float LEAST_OPACITY = 0.25; // otherwise the face could not be picked
const mat4 THRESHOLDS = mat4( // Bayer's ordered dither
    0.5, 12.5, 3.5, 15.5, 8.5, 4.5, 11.5, 7.5, 2.5, 14.5, 1.5, 13.5, 10.5, 6.5, 9.5, 5.5) / 16.0;
const vec3 KEY = normalize(vec3(-0.45, 0.75, 0.60));

void main() {
    // The normal is turned to the camera, whichever side of the face is visible.
    vec3 n = normalize(cross(dFdx(-eye), dFdy(-eye)));
#ifdef LOOKED
    n = smoothNormal(n, eye);
#endif
    float light = 0.34 + 0.46 * max(dot(n, KEY), 0.0)
                + 0.24 * max(dot(n, normalize(eye)), 0.0);
    bool isPainted = !isValued() && glow.w > (gl_FrontFacing ? 0.0 : 1.0);
    vec3 fill = isPainted ? base.rgb : gl_FrontFacing ? FRONT : BACK;
    fill *= light;
    fill = isPainted ? min(fill + glow.rgb, 1.0) : fill;
#ifdef LOOKED
    if (matcap > 0) {
        fill = matcapColor(n, eye) * (isPainted ? 0.25 + 0.95 * base.rgb : vec3(1.0));
    }
    if (marksBacks && !gl_FrontFacing) {
        fill = markedBack(light);
    }
#endif
    fill = isValued() ? colourOfFace() * lightOfValues(light) : fill;
    float bright = max(max(fill.r, fill.g), fill.b);
    // The colour of selected faces stays recognizable where the shading is dark.
    float chosenness = chosen ? (isPainted ? 0.92 : 0.8) : 0.0;
    fill = mix(fill, CHOSEN * (0.5 + 0.5 * light), chosenness);

    // The variable line has the distances in pixels from each side of the triangle: a -> b is
    // opposite the corner of bary.z, and so on.
    vec3 dx = dFdx(bary);
    vec3 dy = dFdy(bary);
    vec3 rate = max(sqrt(dx * dx + dy * dy), vec3(1e-9)).zxy;
    bool isOfEdges = isValued() && valuesOf == OF_EDGES;
    float width = isOfEdges ? 2.5 * edgeWidth : edgeWidth;
    vec3 line = 1.0 - smoothstep(width - 0.6, width + 0.6, bary.zxy / rate);
    line *= vec3(float(sides & 1u), float((sides >> 1) & 1u), float((sides >> 2) & 1u));
    // Without this, the lines of the edges would cover a triangle that is only a few pixels large.
    // If these lines have colours, they may.
    line *= isOfEdges ? vec3(1.0) : smoothstep(1.0, 9.0, 1.0 / rate);
    float nearest = max(max(line.x, line.y), line.z);
#ifdef LOOKED
    cutHere();
    if (!chosen && way == WIRE) {
        vec3 size = 1.0 / rate;
        color = wire(eye, nearest, 1.0 - smoothstep(1.0, 9.0, min(min(size.x, size.y), size.z)));
        return;
    }
    if (!chosen && way == XRAY) {
        color = xray(n, eye, edgeStrength * nearest);
        return;
    }
#endif
    float drawn = (isOfEdges ? 1.0 : edgeStrength) * nearest;
    ivec2 place = ivec2(gl_FragCoord.xy) & 3;
    float opacity = isPainted && !chosen ? max(base.a, LEAST_OPACITY) : 1.0;
    if (max(opacity, drawn) < THRESHOLDS[place.x][place.y]) {
        discard;
    }
    vec3 edge = isOfEdges ? colourOfSide(line)
                          : mix(EDGE_IN_THE_DARK, EDGE, smoothstep(0.12, 0.25, bright));
    color = vec4(mix(fill, edge, drawn), 1.0);
}
`;

// The fragment shader of faces that draws ids instead of colours.
export const SURFACE_PICK = `
precision highp float;
precision highp int;
flat in uint triangle;
out uvec4 id;
#ifdef LOOKED
${CUT_FRAGMENT}
#endif
void main() {
#ifdef LOOKED
    cutHere();
#endif
    id = uvec4(1u, triangle, 0u, 0u);
}
`;

// The vertex shader of dots, which runs for each vertex of the mesh. Vertices that are not to be
// shown are moved out of the clip volume.
export const DOT_VERTEX = `${TEXTURES}
${CUT_VERTEX}
uniform float size;
uniform bool isolatedOnly;
flat out uint vertex;
out float farness; // 0 on the near side of the unit ball, 1 on its far side
void main() {
    vec4 place = vertexAt(gl_VertexID);
    bool wanted = (isolatedOnly ? place.w == 2.0 : place.w > 0.0) && !isCutAway(place.xyz);
    vec4 seen = modelViewMatrix * vec4(place.xyz, 1.0);
    farness = clamp(0.5 + 0.5 * (modelViewMatrix[3].z - seen.z), 0.0, 1.0);
    // A dot faces the camera, so it is moved a little nearer to the camera; otherwise the surface
    // would hide parts of it.
    seen.xyz *= 0.996;
    vertex = uint(gl_VertexID);
    gl_PointSize = size;
    gl_Position = wanted ? projectionMatrix * seen : vec4(2.0, 2.0, 2.0, 1.0);
}
`;

export const DOT_FRAGMENT = `
precision highp float;
precision highp int;
flat in uint vertex;
in float farness;
uniform vec3 tint;
uniform bool isAlone; // the mesh is drawn as points, without faces
uniform vec3 ink;
uniform vec3 paper;
out vec4 color;
void main() {
    float r = 2.0 * length(gl_PointCoord - 0.5);
    if (r > 1.0) {
        discard;
    }
    if (isAlone) {
        color = vec4(mix(ink, paper, 0.82 * farness), 1.0);
        return;
    }
    color = vec4(mix(tint, vec3(0.055, 0.070, 0.095), smoothstep(0.55, 0.75, r)), 1.0);
}
`;

export const DOT_PICK = `
precision highp float;
precision highp int;
flat in uint vertex;
out uvec4 id;
void main() {
    id = uvec4(2u, vertex, 0u, 0u);
}
`;

// The vertex shader of points whose positions are in a vertex buffer: the marked vertices.
export const MARK_VERTEX = `
precision highp float;
in vec3 position;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
${CUT_VERTEX}
uniform float size;
flat out uint vertex;
out float farness;
void main() {
    farness = 0.0;
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    seen.xyz *= 0.985;
    vertex = uint(gl_VertexID);
    gl_PointSize = size;
    gl_Position = isCutAway(position) ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * seen;
}
`;

// The vertex shader of half-edges: coloured triangles in front of the surface, see arrows.js.
// `pixel` is the length of a CSS pixel at depth 1.
export const ARROW_VERTEX = `
precision highp float;
in vec3 position;
in vec3 spread;
in float size;
in vec3 color;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
${CUT_VERTEX}
uniform float pixel;
uniform float mostPixels;
out vec3 tint;
void main() {
    float depth = -(modelViewMatrix * vec4(position, 1.0)).z;
    float scale = min(1.0, mostPixels * pixel * depth / size);
    vec4 seen = modelViewMatrix * vec4(position + scale * spread, 1.0);
    seen.xyz *= 0.994;
    tint = color;
    gl_Position = isCutAway(position) ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * seen;
}
`;

export const ARROW_FRAGMENT = `
precision highp float;
in vec3 tint;
out vec4 color;
void main() {
    color = vec4(tint, 1.0);
}
`;
