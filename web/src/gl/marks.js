// marks.js - draws marks on the mesh: the selection, the elements that the fields of a form name,
// half-edges as arrows, boundary loops, and lines that preview an edit.

import {
    AlwaysDepth,
    BufferAttribute,
    BufferGeometry,
    Color,
    DoubleSide,
    GLSL3,
    GreaterDepth,
    LessEqualDepth,
    Mesh,
    NoBlending,
    NoColorSpace,
    Points,
    RawShaderMaterial,
    Vector3,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

import { MOST_PIXELS, arrowOf } from '../geometry/arrows.js';
import { edgesOfTriangles, hasVertex, pointAt, trianglesOfFace } from '../geometry/geometry.js';
import { pixelAtOne } from '../geometry/view.js';
import { COLORS } from './colors.js';
import { ARROW_FRAGMENT, ARROW_VERTEX, DOT_FRAGMENT, MARK_VERTEX } from './shaders.js';

const MARK_SIZE = 13; // in CSS pixels, as all sizes here
const LINE_WIDTH = 4;
const BOUNDARY_WIDTH = 3;
const PREVIEW_WIDTH = 2;
const FIELD_WIDTH = 3;
export const RAISED = 0.996; // lines are drawn at this part of their distance from the camera

export class Marks {
    // The objects of three.js by which the marks are drawn.
    chosen;
    boundary;
    arrows;
    hiddenLines;
    lines;
    vertices;
    fieldLines;
    fieldVertices;
    preview;
    #geometry = null;
    #shown = { marks: [], halfedges: [], ends: [] }; // the arguments of select() and setBoundary()
    #pixel = { value: 1 };
    #colors = COLORS.dark;
    #halfedges = [];
    #lined = [[], false]; // the arguments of #setLines()

    // `materials` are those with which three.js draws selected triangles, `cut`, `ink` and `paper` are
    // uniforms of SurfaceLook.
    constructor(materials, { cut, ink, paper }) {
        // Selected triangles are drawn a second time, a little nearer than the rest of the mesh.
        this.chosen = new Mesh(new BufferGeometry(), materials[0]);
        for (const material of materials) {
            material.polygonOffsetFactor = 0.5;
            material.polygonOffsetUnits = 0.5;
        }
        this.boundary = segments(plain(line(LessEqualDepth, 1), BOUNDARY_WIDTH));
        this.arrows = new Mesh(
            new BufferGeometry(),
            new RawShaderMaterial({
                glslVersion: GLSL3,
                vertexShader: ARROW_VERTEX,
                fragmentShader: ARROW_FRAGMENT,
                uniforms: { pixel: this.#pixel, mostPixels: { value: MOST_PIXELS }, cut },
                side: DoubleSide,
                blending: NoBlending,
            }),
        );
        // Lines are drawn twice: clearly where they are in front of the surface, and faintly where
        // they are behind it.
        this.lines = segments(line(LessEqualDepth, 1));
        this.hiddenLines = new LineSegments2(this.lines.geometry, line(GreaterDepth, 0.3));
        this.vertices = dots(new Vector3(), { cut, ink, paper });
        this.fieldLines = segments(plain(line(AlwaysDepth, 1), FIELD_WIDTH));
        this.fieldVertices = dots(new Vector3(0.96, 0.97, 0.98), { cut, ink, paper });
        this.preview = segments(plain(line(AlwaysDepth, 1), PREVIEW_WIDTH));
        this.preview.visible = false;
        this.setColors(this.#colors);
    }

    // Sets the colours of the marks, see colors.js.
    setColors(colors) {
        this.#colors = colors;
        this.boundary.material.color.set(colors.boundary);
        this.preview.material.color.set(colors.preview);
        this.fieldLines.material.color.set(colors.field);
        for (const [points, color] of [
            [this.fieldVertices, colors.field],
            [this.vertices, colors.chosen],
        ]) {
            points.material.uniforms.tint.value.setFromColor(new Color().setHex(color, NoColorSpace));
        }
        this.#setLines(...this.#lined);
        this.#setArrows(this.#halfedges);
    }

    // Hides the marks above a plane, a Plane of three.js, or none (null). Those of the fields of a
    // form and previews stay.
    setCut(plane) {
        for (const { material } of [this.lines, this.hiddenLines, this.boundary]) {
            material.clippingPlanes = plane === null ? null : [plane];
        }
    }

    // Removes all marks; `geometry` is the mesh that will be marked from now on, or null.
    reset(geometry) {
        this.#geometry = geometry;
        this.setBoundary([]);
        this.setField([]);
        this.select([], []);
    }

    // Draws the marks of the selection and of boundary loops anew on the arrays `geometry`, which
    // have the same vertices at other places.
    move(geometry) {
        this.#geometry = geometry;
        this.select(this.#shown.marks, this.#shown.halfedges);
        this.setBoundary(this.#shown.ends);
    }

    // Marks the selected elements and draws half-edges as arrows; the arguments are as in
    // Renderer.select().
    select(marks, halfedges) {
        if (this.#geometry === null) {
            [marks, halfedges] = [[], []];
        }
        Object.assign(this.#shown, { marks, halfedges });
        const geometry = this.#geometry;
        const triangles = idsOf(marks, 'face').flatMap((face) => trianglesOfFace(geometry, face));
        const edges = edgesOfTriangles(geometry?.triangles, triangles);
        let directed = false;
        for (const mark of marks) {
            if (mark.kind === 'edge' || mark.kind === 'halfedge') {
                edges.push([mark.from, mark.to]);
                directed ||= mark.kind === 'halfedge';
            }
        }
        this.#setChosen(triangles);
        this.#setLines(edges.flat(), directed);
        this.#setDots(this.vertices, idsOf(marks, 'vertex'));
        this.#setArrows(halfedges);
    }

    // Outlines the elements that the fields of a form name; `marks` has the form of the argument of
    // select().
    setField(marks) {
        const edges = marks.flatMap(({ kind, id, from, to }) => {
            if (kind === 'face') {
                const triangles = trianglesOfFace(this.#geometry, id);
                return edgesOfTriangles(this.#geometry.triangles, triangles);
            }
            return kind === 'vertex' ? [] : [[from, to]];
        });
        replace(this.fieldLines, this.#between(edges.flat()), edges.length > 0);
        this.#setDots(this.fieldVertices, idsOf(marks, 'vertex'));
    }

    // Draws the preview of an edit over everything: lines, given by the coordinates of their end
    // points; null removes it.
    setPreview(coordinates) {
        const geometry = new LineSegmentsGeometry();
        if (coordinates !== null && coordinates.length > 0) {
            geometry.setPositions(coordinates);
        }
        replace(this.preview, geometry, (coordinates?.length ?? 0) > 0);
    }

    // Draws the edges of boundary loops; `ends` are the ids of the edges' vertices in pairs. The
    // ids may be from an earlier revision, so edges whose vertices were deleted are left out.
    setBoundary(ends) {
        const live = [];
        this.#shown.ends = ends;
        for (let i = 0; this.#geometry !== null && i < ends.length; i += 2) {
            if (hasVertex(this.#geometry, ends[i]) && hasVertex(this.#geometry, ends[i + 1])) {
                live.push(ends[i], ends[i + 1]);
            }
        }
        replace(this.boundary, this.#between(live), live.length > 0);
    }

    #setChosen(triangles) {
        const corners = triangles.flatMap((one) => [3 * one, 3 * one + 1, 3 * one + 2]);
        const geometry = new BufferGeometry();
        geometry.setIndex(new BufferAttribute(new Uint32Array(corners), 1));
        replace(this.chosen, geometry, corners.length > 0);
    }

    #setLines(ends, directed) {
        this.#lined = [ends, directed];
        const geometry = this.#between(ends);
        if (ends.length > 0) {
            const { chosen: end, chosenStart } = this.#colors;
            const [chosen, start] = [end, chosenStart].map((hex) => new Color(hex).toArray());
            const colors = ends.flatMap((_, i) => (directed && i % 2 === 0 ? start : chosen));
            geometry.setColors(colors);
        }
        replace(this.lines, geometry, ends.length > 0);
        this.hiddenLines.geometry = geometry;
        this.hiddenLines.visible = ends.length > 0;
    }

    // Returns the geometry of lines between vertices, whose ids come in pairs.
    #between(ends) {
        const geometry = new LineSegmentsGeometry();
        if (ends.length > 0) {
            const { vertices } = this.#geometry;
            const points = new Float32Array(3 * ends.length);
            for (let i = 0; i < ends.length; i++) {
                for (let axis = 0; axis < 3; axis++) {
                    points[3 * i + axis] = vertices[4 * ends[i] + axis];
                }
            }
            geometry.setPositions(points);
        }
        return geometry;
    }

    #setArrows(halfedges) {
        this.#halfedges = halfedges;
        const [position, spread, size, color] = [[], [], [], []];
        for (const halfedge of halfedges) {
            const arrow = arrowOf(this.#geometry, halfedge);
            const tint = new Color().setHex(this.#colors.arrows[halfedge.role], NoColorSpace).toArray();
            for (let i = 0; i < (arrow?.places.length ?? 0); i++) {
                position.push(...arrow.places[i]);
                spread.push(...arrow.spreads[i]);
                size.push(arrow.size);
                color.push(...tint);
            }
        }
        const geometry = new BufferGeometry();
        for (const [name, array] of Object.entries({ position, spread, size, color })) {
            const values = new BufferAttribute(new Float32Array(array), array === size ? 1 : 3);
            geometry.setAttribute(name, values);
        }
        replace(this.arrows, geometry, size.length > 0);
    }

    #setDots(dots, vertices) {
        const points = vertices.flatMap((vertex) => pointAt(this.#geometry, vertex));
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
        replace(dots, geometry, points.length > 0);
    }

    // Sets the size of the picture: `ratio` is the number of screen pixels per CSS pixel, `height`
    // the height of the canvas in CSS pixels.
    setScreen(ratio, height) {
        for (const { material } of [this.vertices, this.fieldVertices]) {
            material.uniforms.size.value = MARK_SIZE * ratio;
        }
        this.#pixel.value = pixelAtOne(height);
    }

    // Scales lines towards the camera at `position`, so that a slanted surface does not hide parts
    // of them. Their places on the screen stay the same.
    raise(position) {
        for (const lines of [this.lines, this.hiddenLines, this.boundary]) {
            lines.scale.setScalar(RAISED);
            lines.position.copy(position).multiplyScalar(1 - RAISED);
        }
    }
}

function replace(object, geometry, visible) {
    object.geometry.dispose();
    object.geometry = geometry;
    object.visible = visible;
}

// Returns an object of three.js that draws points as dots of a colour; `uniforms` are those of the look.
export function dots(tint, uniforms) {
    return new Points(
        new BufferGeometry(),
        new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: MARK_VERTEX,
            fragmentShader: DOT_FRAGMENT,
            uniforms: {
                ...uniforms,
                size: { value: MARK_SIZE },
                tint: { value: tint },
                isAlone: { value: false },
            },
            blending: NoBlending,
        }),
    );
}

function segments(material) {
    return new LineSegments2(new LineSegmentsGeometry(), material);
}

function line(depthFunc, opacity) {
    return new LineMaterial({
        linewidth: LINE_WIDTH,
        vertexColors: true,
        depthFunc,
        depthWrite: false,
        transparent: true,
        opacity,
    });
}

// Sets the width of a material for lines, which have one colour instead of a colour for each vertex.
function plain(material, width) {
    material.linewidth = width;
    material.vertexColors = false;
    return material;
}

function idsOf(marks, kind) {
    return marks.filter((mark) => mark.kind === kind).map(({ id }) => id);
}
