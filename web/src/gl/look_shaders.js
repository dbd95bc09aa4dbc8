// look_shaders.js - the parts of the GLSL programs that draw the mesh in other ways than plainly:
// smoothly, with a matcap, as wires, as X-ray, cut by a plane. shaders.js includes them where the
// macro LOOKED is defined; a program without them draws the mesh plainly and does less.

// For vertex shaders: `place` is a place in view coordinates.
export const CUT_VERTEX = `
uniform vec4 cut; // what is above the plane dot(cut.xyz, place) = cut.w is cut away; 0 cuts nothing
bool isCutAway(vec3 place) {
    return dot(cut.xyz, place) > cut.w;
}
`;

// For the vertex shader of faces. See normals.js about packed normals.
export const LOOK_VERTEX = `
${CUT_VERTEX}
uniform usampler2D normals;
uniform bool isSmooth;
// In the coordinates of the camera; 0 if the triangle is drawn flat. Without 'centroid' it would be wrong
// at the rim of triangles, where the middle of a pixel is outside.
centroid out vec3 normal;
out float above; // height above the cutting plane

vec3 unpackNormal(uint word) {
    vec2 square = vec2(float(word & 0xffffu), float(word >> 16)) / 32767.5 - 1.0;
    vec3 n = vec3(square, 1.0 - abs(square.x) - abs(square.y));
    if (n.z < 0.0) {
        n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    }
    return normalize(n);
}

void lookAtCorner(int index, int corner, vec3 place) {
    above = dot(cut.xyz, place) - cut.w;
    normal = vec3(0.0);
    if (isSmooth) {
        int width = textureSize(normals, 0).x;
        uint word = texelFetch(normals, ivec2(index % width, index / width), 0)[corner];
        if (word != 0u) {
            normal = mat3(modelViewMatrix) * unpackNormal(word);
        }
    }
}
`;

// For the fragment shader that draws ids.
export const CUT_FRAGMENT = `
in float above;
void cutHere() {
    if (above > 0.0) {
        discard;
    }
}
`;

// For the fragment shader of faces. The numbers of ways and matcaps are in surface_look.js.
export const LOOK_FRAGMENT = `
${CUT_FRAGMENT}
uniform int way;
uniform int matcap;
uniform bool marksBacks;
uniform vec3 ink; // colour of lines without a surface
uniform vec3 paper; // colour of the background
uniform mat4 modelViewMatrix;
centroid in vec3 normal;

const int XRAY = 1;
const int WIRE = 2;

// Returns the normal for smooth shading, turned to the side that is visible like the flat one, n.
// Along the outline of a mesh, normals turn away from the camera, and backs are seen between pixels:
// there the normal is bent back instead of being turned round.
vec3 smoothNormal(vec3 n, vec3 eye) {
    if (dot(normal, normal) < 0.01) {
        return n;
    }
    vec3 m = normalize(normal);
    vec3 z = normalize(eye);
    m = !gl_FrontFacing && dot(m, z) < -0.3 ? -m : m;
    return normalize(m + max(0.02 - dot(m, z), 0.0) * z);
}

// --- matcaps: the colour depends only on the direction of the normal, as seen by the camera ---

// Returns the normal in a frame whose z axis points from the surface to the camera.
vec3 seenNormal(vec3 n, vec3 eye) {
    vec3 z = normalize(eye);
    vec3 x = normalize(vec3(z.z, 0.0, -z.x));
    return vec3(dot(x, n), dot(cross(z, x), n), dot(z, n));
}
vec3 clay(vec3 m) {
    float key = dot(m, normalize(vec3(-0.50, 0.65, 0.58)));
    float cool = dot(m, normalize(vec3(0.85, -0.45, 0.15)));
    vec3 c = mix(vec3(0.20, 0.09, 0.075), vec3(0.74, 0.43, 0.32), smoothstep(-0.55, 0.70, key));
    c = mix(c, vec3(0.97, 0.79, 0.68), 0.75 * smoothstep(0.60, 1.0, key));
    return c + vec3(0.10, 0.13, 0.19) * smoothstep(0.25, 1.0, cool);
}
vec3 metal(vec3 m) {
    float sky = 0.86 * m.y - 0.28 * m.x + 0.12 * m.z;
    vec3 c = mix(vec3(0.10, 0.11, 0.13), vec3(0.56, 0.60, 0.65), smoothstep(-0.85, 0.0, sky));
    c = mix(c, vec3(0.19, 0.21, 0.25), smoothstep(0.0, 0.16, sky));
    c = mix(c, vec3(0.96, 0.98, 1.0), smoothstep(0.20, 0.72, sky));
    return c * (0.72 + 0.28 * smoothstep(0.0, 0.5, m.z));
}
vec3 pearl(vec3 m) {
    float key = dot(m, normalize(vec3(-0.35, 0.70, 0.62)));
    vec3 c = mix(vec3(0.40, 0.39, 0.47), vec3(0.93, 0.92, 0.91), smoothstep(-0.45, 0.85, key));
    vec3 sheen = 0.5 + 0.5 * cos(6.2832 * (0.9 * m.z + vec3(0.0, 0.33, 0.67)));
    return mix(c, c * (0.75 + 0.40 * sheen), 0.40 * (1.0 - m.z)) + 0.12 * smoothstep(0.93, 1.0, key);
}
vec3 matcapColor(vec3 n, vec3 eye) {
    vec3 m = seenNormal(n, eye);
    return matcap == 1 ? clay(m) : matcap == 2 ? metal(m) : pearl(m);
}

// The back of faces: red with stripes, so that it is also recognized by those who see no red.
vec3 markedBack(float light) {
    float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 12.0));
    return mix(vec3(0.86, 0.20, 0.22), vec3(0.60, 0.10, 0.14), stripe) * (0.55 + 0.45 * light);
}

// Returns how far away a place is: 0 on the near side of the unit ball, 1 on its far side.
float farness(vec3 eye) {
    return clamp(0.5 + 0.5 * (eye.z + modelViewMatrix[3].z), 0.0, 1.0);
}

// Returns the colour and the opacity of the mesh as a net of lines. Lines that are farther away are
// fainter. 'line' is 1 on an edge; 'tiny' is 1 where triangles are so small that lines would fill them.
vec4 wire(vec3 eye, float line, float tiny) {
    return vec4(mix(ink, paper, 0.82 * farness(eye)), max(line, 0.45 * tiny));
}

// Returns the colour and the opacity of the mesh as seen through: opaque where the line of sight grazes
// the surface. All parts have nearly the same colour, so their order hardly matters.
vec4 xray(vec3 n, vec3 eye, float line) {
    float rim = 1.0 - abs(dot(n, normalize(eye)));
    return vec4(mix(vec3(0.42, 0.58, 0.80), ink, 0.45), max(0.07 + 0.5 * rim * rim, 0.32 * line));
}
`;
