// value_shader.js - the part of the shaders of faces that colours the mesh by values of its elements.
//
// The values are in a texture that values.js fills: a number for each slot, four in a texel, or a
// vector for each slot, one in a texel. What a slot is depends on the kind of the elements.

// Kinds of elements that have values; for edges, the value of a corner is that of the edge that leads
// to the next corner.
export const OF = { nothing: 0, vertices: 1, faces: 2, halfedges: 3, edges: 4 };

// What the values mean.
export const AS = { number: 0, category: 1, colour: 2, direction: 3, checker: 4 };

// A number below this stands for an element without a value.
export const NO_VALUE = -1e30;

const CONSTANTS = `
const int OF_NOTHING = ${OF.nothing};
const int OF_VERTICES = ${OF.vertices};
const int OF_FACES = ${OF.faces};
const int OF_EDGES = ${OF.edges};
const int AS_CATEGORY = ${AS.category};
const int AS_COLOUR = ${AS.colour};
const int AS_DIRECTION = ${AS.direction};
const int AS_CHECKER = ${AS.checker};
uniform int valuesOf;
uniform int valuesAs;
`;

// Declares putValue(), which the vertex shader calls for each corner of a triangle. `value` gets the
// value of the corner and, as its last part, 1 if it is known, else 0; `sideValues` gets those of the
// three edges of the triangle.
export const VALUE_VERTEX = `${CONSTANTS}
uniform sampler2D values;
out vec4 value;
flat out vec3 sideValues;

vec4 valueAt(int slot) {
    int width = textureSize(values, 0).x;
    bool isVector = valuesAs >= AS_COLOUR;
    int place = isVector ? slot : slot / 4;
    if (place / width >= textureSize(values, 0).y) {
        return vec4(0.0);
    }
    vec4 found = texelFetch(values, texel(place, width), 0);
    if (isVector) {
        return found;
    }
    float number = found[slot % 4];
    return number < ${NO_VALUE} ? vec4(0.0) : vec4(number, 0.0, 0.0, 1.0);
}

float sideAt(int slot) {
    vec4 found = valueAt(slot);
    return found.w > 0.5 ? found.x : 2.0 * ${NO_VALUE};
}

void putValue(int triangle, int corner, uint vertex, uint face) {
    value = vec4(0.0);
    sideValues = vec3(0.0);
    if (valuesOf == OF_EDGES) {
        sideValues = vec3(sideAt(3 * triangle), sideAt(3 * triangle + 1), sideAt(3 * triangle + 2));
    } else if (valuesOf != OF_NOTHING) {
        value = valueAt(valuesOf == OF_VERTICES ? int(vertex)
                        : valuesOf == OF_FACES ? int(face) : 3 * triangle + corner);
    }
}
`;

// Declares isValued(), colourOfFace() and colourOfSide() for the fragment shader.
export const VALUE_FRAGMENT = `${CONSTANTS}
precision highp sampler2D;
uniform sampler2D colours;
uniform vec2 valueRange;
uniform float valueShade;
in vec4 value;
flat in vec3 sideValues;

const vec3 MISSING = vec3(128.0 / 255.0);
const vec3 DARK_SQUARE = vec3(0.16, 0.20, 0.28);
const vec3 LIGHT_SQUARE = vec3(0.93, 0.91, 0.86);
const vec3 BESIDE_EDGES = vec3(0.30, 0.33, 0.38);

bool isValued() {
    return valuesOf != OF_NOTHING;
}

// The colour of a number, which the range of the legend maps to 0 to 1, or of a category.
vec3 colourOfNumber(float number) {
    if (number < ${NO_VALUE}) {
        return MISSING;
    }
    int last = textureSize(colours, 0).x - 1;
    if (valuesAs == AS_CATEGORY) {
        return texelFetch(colours, ivec2(int(number + 0.5) % (last + 1), 0), 0).rgb;
    }
    float width = valueRange.y - valueRange.x;
    float part = width > 0.0 ? (number - valueRange.x) / width : step(valueRange.y, number);
    int index = int(clamp(part, 0.0, 1.0) * float(last) + 0.5);
    return texelFetch(colours, ivec2(index, 0), 0).rgb;
}

// The colour of this place of a face. Where a corner of the triangle has no value, there is none.
vec3 colourOfFace() {
    if (valuesOf == OF_EDGES) {
        return BESIDE_EDGES;
    }
    if (value.w < 0.999) {
        return MISSING;
    }
    if (valuesAs == AS_COLOUR) {
        return clamp(value.rgb, 0.0, 1.0);
    }
    if (valuesAs == AS_DIRECTION) {
        float size = length(value.xyz);
        return size > 0.0 ? 0.5 + 0.5 * value.xyz / size : MISSING;
    }
    if (valuesAs == AS_CHECKER) {
        vec2 square = floor(value.xy * 8.0);
        return mod(square.x + square.y, 2.0) < 0.5 ? DARK_SQUARE : LIGHT_SQUARE;
    }
    return colourOfNumber(value.x);
}

// The colour of the edge that is nearest in a triangle; line says how much each of its sides is
// drawn here.
vec3 colourOfSide(vec3 line) {
    float number = line.x >= max(line.y, line.z) ? sideValues.x
                 : line.y >= line.z ? sideValues.y : sideValues.z;
    return colourOfNumber(number);
}

// How much of the light on the surface reaches the colours of values: without shading all of it.
float lightOfValues(float light) {
    return mix(1.0, min(0.45 + 0.55 * light, 1.0), valueShade);
}
`;
