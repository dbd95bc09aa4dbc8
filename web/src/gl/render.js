// render.js - draws the surface of the mesh and the marks on it. Only this folder knows WebGL and
// three.
//
//   surface.js   the mesh, from the arrays of geometry.js
//   cut.js       the face that a section plane cuts
//   guides.js    grid, axes and bounding box
//   marks.js     the marks on it: selection, arrows, boundary loops, previews
//   rulers.js    lines that measure
//   many.js      a selection of many elements
//   ids.js       which element is visible at a pixel
//   tints.js     elements in other colours: what changed, what other clients have selected
//   past.js      an earlier revision in a part of the picture
//   camera.js    the position of the camera
//
// A frame is drawn only after a change. After each frame `onFrame` is called with a label that says
// what the frame shows, so that a test can wait for a certain frame instead of a time.

import { Plane, Scene, Vector3, WebGLRenderer } from 'three';

import { ballOf } from '../geometry/geometry.js';
import { DIRECTION } from '../geometry/view.js';
import { Camera } from './camera.js';
import { COLORS } from './colors.js';
import { Cut } from './cut.js';
import { Guides } from './guides.js';
import { Ids } from './ids.js';
import { Many } from './many.js';
import { Marks } from './marks.js';
import { Motion } from './motion.js';
import { Rulers } from './rulers.js';
import { Past } from './past.js';
import { Surface } from './surface.js';
import { Tints } from './tints.js';

export class NoWebGL extends Error {}

export class Renderer {
    #canvas;
    #renderer;
    #camera;
    #surface;
    #marks;
    #chosen; // materials of selected faces
    #cut = new Cut();
    #guides = new Guides();
    #motion = new Motion(() => this.#draw());
    #hurry = 'auto';
    #colors = COLORS.dark;
    #rulers = new Rulers();
    #many;
    #ids;
    #tints = new Tints();
    #past;
    #scene = new Scene();
    #pickScene = new Scene();
    #geometry = null;
    #label = null;
    #size = '';
    #scheduled = false;
    #onFrame;
    #onSlow;
    #onBroken;

    // Throws NoWebGL if the browser cannot draw. `onFrame(label)` is called after each frame with
    // the label of the last change, `onLost(lost)` when the graphics context is lost or restored,
    // `onMove(isHeld)` when the camera moves, see Camera, `onSlow()` when frames are slow while it
    // moves and there is no proxy, and `onBroken()` when the browser cannot draw the look, so that the
    // mesh is drawn plainly.
    constructor(canvas, { onFrame, onLost, onMove, onSlow, onBroken }) {
        const context = canvas.getContext('webgl2', {
            antialias: true,
            alpha: false,
            stencil: true,
        });
        if (context === null) {
            throw new NoWebGL();
        }
        this.#canvas = canvas;
        [this.#onFrame, this.#onSlow, this.#onBroken] = [onFrame, onSlow, onBroken];
        this.#renderer = new WebGLRenderer({ canvas, context });
        this.#renderer.localClippingEnabled = true;
        this.#renderer.debug.onShaderError = (...which) => this.#giveUpLook(...which);
        this.#camera = new Camera(canvas, (isHeld) => {
            this.#motion.moved();
            this.#ids.forget();
            this.#draw();
            onMove(isHeld);
        });
        this.#surface = new Surface(this.#renderer.capabilities.maxTextureSize);
        this.#chosen = this.#surface.chosenMaterials();
        this.#marks = new Marks(Object.values(this.#chosen), this.#surface.look.uniforms);
        this.#many = new Many(this.#chosen.plain, this.#surface.look.uniforms);
        this.#ids = new Ids(this.#renderer, this.#pickScene, this.#camera, () => this.#colors.paper);
        const { fill, proxy, dots, pickFill, pickDots } = this.#surface;
        const { mask, face, outline } = this.#cut;
        this.#past = new Past(this.#renderer.capabilities.maxTextureSize);
        const { chosen, boundary, arrows, hiddenLines, lines, vertices } = this.#marks;
        const { fieldLines, fieldVertices, preview } = this.#marks;
        add(this.#pickScene, [pickFill, pickDots]);
        const { faces, lines: manyLines, points } = this.#many;
        add(this.#scene, [
            ...[this.#guides.grid, this.#guides.axes, this.#guides.box],
            fill,
            proxy,
            chosen,
            mask,
            face,
            outline,
            faces,
            boundary,
            dots,
            manyLines,
            points,
            arrows,
            hiddenLines,
            lines,
            vertices,
            fieldLines,
            fieldVertices,
            preview,
            ...this.#rulers.objects,
        ]);
        this.#scene.add(this.#tints.group);
        this.setColors('dark');
        this.show(null, null);
        this.fit();
        canvas.addEventListener('webglcontextlost', () => {
            this.#surface.forget();
            this.#ids.forget();
            this.#past.forget();
            onLost(true);
        });
        canvas.addEventListener('webglcontextrestored', () => {
            onLost(false);
            this.#draw();
        });
        new ResizeObserver(() => this.#resize()).observe(canvas);
    }

    // Shows a mesh, or nothing (null). `label` is passed to onFrame. Throws a RangeError if the
    // mesh is too large for a texture; then the mesh that was shown before stays visible.
    show(geometry, label) {
        this.#surface.show(geometry);
        this.#surface.values.hide(); // they belong to other elements
        this.#geometry = geometry;
        this.#ids.forget();
        this.#marks.reset(geometry);
        this.#many.show(null, null);
        this.#label = label;
        this.#draw();
    }

    // Called when the arrays of the mesh have changed at some places, see applyDelta(): uploads
    // only what has changed. The marks of boundary loops and of the selection stay. Throws a
    // RangeError if the mesh is too large for a texture.
    update(places, label) {
        if (this.#geometry !== null) {
            this.#surface.update(places);
            this.#marks.move(this.#geometry);
        }
        this.#ids.forget();
        this.#label = label;
        this.#draw();
    }

    // Called when another level of detail is to be shown: the arrays have changed within `ranges`,
    // and the numbers of vertices and triangles have changed, see Levels.
    refine(ranges, label) {
        this.#surface.refine(ranges);
        this.#ids.forget();
        this.#label = label;
        this.#draw();
    }

    // Sets the materials of faces, see Surface.showMaterials().
    showMaterials(materials, label) {
        this.#surface.showMaterials(materials);
        this.#label = label;
        this.#draw();
    }

    // Applies a change of the materials, see Surface.updateMaterials().
    updateMaterials(materials, change, label) {
        this.#surface.updateMaterials(materials, change);
        this.#label = label;
        this.#draw();
    }

    // Shows or hides the colours of materials.
    colorFaces(isColored) {
        this.#surface.isColored = isColored;
        this.#draw();
    }

    // Colours the faces by values, see Values, which `act(values)` sets; `label` is as in show().
    color(act, label) {
        act(this.#surface.values);
        this.#label = label;
        this.#draw();
    }

    // Shows a selection of many elements, a Crowd, or none (null).
    selectMany(crowd) {
        this.#many.show(this.#geometry === null ? null : crowd, this.#geometry);
        this.#draw();
    }

    // Marks the selected elements, each {kind: 'face', id}, {kind: 'edge' or 'halfedge', from, to}
    // or {kind: 'vertex', id}, and draws `halfedges` as arrows, see around.js. These marks and
    // arrows replace those of earlier calls.
    select(marks, halfedges, label) {
        this.#label = label;
        this.#marks.select(marks, halfedges);
        this.#draw();
    }

    // Marks the elements that the fields of a form name; `marks` has the form of the argument of
    // select().
    markField(marks) {
        this.#marks.setField(this.#geometry === null ? [] : marks);
        this.#draw();
    }

    // Draws the preview of an edit over everything: lines, given by the coordinates of their end
    // points; null removes it.
    preview(coordinates) {
        this.#marks.setPreview(coordinates);
        this.#draw();
    }

    // Shows vertices at other places, see Surface.bend(), with the marks of the selection.
    bend(ids, places) {
        const geometry = this.#surface.bend(ids, places);
        if (geometry !== null) {
            this.#marks.move(geometry);
        }
        this.#draw();
    }

    // Draws lines and points over everything, see Rulers.show().
    rule(lines, points) {
        this.#rulers.show(lines, points);
        this.#draw();
    }

    // Draws some shapes in other colours, in place of those with the same name, see Tints.set().
    tint(name, shapes) {
        this.#tints.set(name, shapes);
        this.#draw();
    }

    // Shows an earlier revision, or none (null), see Past.show(); `tints` are shapes to draw on it.
    showPast(geometry, placement, tints, label) {
        this.#past.show(geometry, placement);
        this.#past.tints.set('changed', tints);
        this.#label = label;
        this.#draw();
    }

    // Shows the earlier revision in this part of the picture's width, 0 to 1.
    wipe(part) {
        this.#past.part = part;
        this.#draw();
    }

    // Draws the edges of boundary loops, see Marks.setBoundary().
    setBoundary(ends) {
        this.#marks.setBoundary(ends);
        this.#draw();
    }

    // Shows all vertices as dots, or only isolated vertices, which would otherwise be invisible.
    showVertices(all) {
        this.#surface.showVertices(all);
        this.#ids.forget();
        this.#draw();
    }

    // --- the look ---

    // Sets how faces are drawn, see PLAIN in surface_look.js.
    setLook(look) {
        this.#surface.setLook(look);
        this.#setChosen();
        this.#draw();
    }

    // Sets the normals for smooth shading, see SurfaceLook.setNormals().
    setNormals(normals) {
        this.#surface.look.setNormals(normals);
        this.#draw();
    }

    // Cuts away what is above a plane {normal, at}, or nothing (null); `outline` is the result of
    // cutOutline() for this plane, or null.
    setCut(plane, outline) {
        this.#surface.setCut(plane);
        // three.js hides what has a negative distance from the plane.
        const shown =
            plane && new Plane(new Vector3(...plane.normal).multiplyScalar(-1), plane.at);
        this.#marks.setCut(shown);
        this.#many.setCut(shown);
        this.#tints.setCut(shown);
        this.#cut.show(outline);
        this.#setChosen();
        this.#ids.forget(); // clicks must not pick what is cut away
        this.#draw();
    }

    // Draws guides, see Guides.show().
    setGuides(lines) {
        this.#guides.show(lines);
        this.#draw();
    }

    // Sets what is drawn while the camera moves: 'auto' is the proxy if frames are slow, 'always' the
    // proxy, 'never' the mesh.
    setHurry(hurry) {
        this.#hurry = hurry;
    }

    // Sets the triangles to draw while the camera moves, see Surface.setProxy().
    setProxy(proxy) {
        this.#surface.setProxy(proxy);
        this.#draw();
    }

    // Sets the colours of the ground and of the marks: 'dark' or 'light'.
    setColors(theme) {
        this.#colors = COLORS[theme];
        this.#renderer.setClearColor(this.#colors.paper, 1);
        this.#surface.look.setColors(this.#colors);
        this.#marks.setColors(this.#colors);
        this.#many.setColors(this.#colors);
        this.#rulers.setColors(this.#colors);
        this.#guides.setColors(this.#colors);
        this.#draw();
    }

    #setChosen() {
        const { plain, looked } = this.#chosen;
        const material = this.#surface.look.isPlain ? plain : looked;
        this.#marks.chosen.material = material;
        this.#many.faces.material = material;
    }

    // Called when a program does not compile. If it is one for looks, the mesh is drawn plainly.
    #giveUpLook(gl, program, ...shaders) {
        const isLook = shaders.some((one) => gl.getShaderSource(one).includes('#define LOOKED'));
        if (isLook && !this.#surface.giveUpLook()) {
            return; // said before
        }
        if (isLook) {
            this.setCut(null, null);
        }
        const texts = shaders.map((one) => gl.getShaderInfoLog(one));
        this.#onBroken(texts.find((text) => text) || gl.getProgramInfoLog(program) || '');
    }

    // --- the camera ---

    // Shows the whole mesh from the default direction.
    fit() {
        const { center, radius } = ballOf(this.#geometry ?? { vertices: [] });
        this.#move(() => this.#camera.look(center, DIRECTION, radius));
    }

    // Moves the camera so that it sees some elements, see Camera.frame().
    frame(found) {
        this.#move(() => this.#camera.frame(found));
    }

    // Zooms in (true) or out (false) by one step.
    zoom(nearer) {
        this.#move(() => this.#camera.zoom(nearer));
    }

    #move(act) {
        // Adapts the picture to the canvas, whose size may have changed, because the panels appear
        // with a mesh.
        this.#resize();
        act();
    }

    // Returns position and axes of the camera, see Camera.view.
    get view() {
        return this.#camera.view;
    }

    // Position of the camera and of the point that it looks at: six numbers.
    get camera() {
        return this.#camera.numbers;
    }

    set camera(numbers) {
        this.#move(() => {
            this.#camera.numbers = numbers;
        });
    }

    // Returns the ray from the camera through a place on the screen, see Camera.rayAt().
    rayAt(x, y) {
        return this.#camera.rayAt(x, y);
    }

    // Returns the matrix of view and projection, see Camera.matrix.
    get matrix() {
        return this.#camera.matrix;
    }

    // --- frames ---

    // Returns the screen as a Blob of image/png.
    capture() {
        this.#surface.hurry(false);
        this.#render();
        return new Promise((resolve) => this.#canvas.toBlob(resolve, 'image/png'));
    }

    // Returns which triangles and vertices are visible near a place on the canvas, see Ids.look().
    // Vertices are included only if they are shown as dots.
    look(x, y, reach, isKept = false) {
        return this.#ids.look(x, y, reach, isKept);
    }

    // Returns which triangle is visible in each pixel, see Ids.triangles().
    get shownTriangles() {
        return this.#ids.triangles(this.#surface.pickDots);
    }

    #resize() {
        const width = Math.max(this.#canvas.clientWidth, 1);
        const height = Math.max(this.#canvas.clientHeight, 1);
        const ratio = window.devicePixelRatio;
        const size = `${width} ${height} ${ratio}`;
        if (size === this.#size) {
            return; // without a new frame, because drawing a large mesh takes long
        }
        this.#size = size;
        this.#ids.forget();
        this.#renderer.setPixelRatio(ratio);
        this.#renderer.setSize(width, height, false);
        this.#camera.setAspect(width / height);
        this.#surface.setPixelRatio(ratio);
        this.#marks.setScreen(ratio, height);
        this.#cut.setPixelRatio(ratio);
        this.#rulers.setScreen(ratio);
        this.#many.setPixelRatio(ratio);
        this.#tints.setPixelRatio(ratio);
        this.#past.setPixelRatio(ratio);
        this.#draw();
    }

    #draw() {
        if (this.#scheduled) {
            return;
        }
        this.#scheduled = true;
        this.#motion.ask();
        requestAnimationFrame(() => {
            this.#scheduled = false;
            this.#setHurry();
            this.#render();
            this.#onFrame(this.#label);
        });
    }

    // Decides whether the next frame shows the proxy. Once frames were slow, the proxy is used each
    // time the camera moves.
    #setHurry() {
        const isSlow = this.#motion.isSlow();
        const isHurried = this.#motion.isMoving && this.#hurry !== 'never';
        if (!this.#surface.hurry(isHurried) && isHurried && isSlow) {
            this.#onSlow();
        }
        this.#canvas.dataset.drawn = this.#surface.isHurried ? 'proxy' : 'mesh';
    }

    #render() {
        this.#camera.setDepthRange(this.#guides.reach);
        this.#marks.raise(this.#camera.three.position);
        this.#cut.raise(this.#camera.three.position);
        this.#many.raise(this.#camera.three.position);
        if (this.#past.isShown) {
            const { clientWidth, clientHeight } = this.#canvas;
            const size = [clientWidth, clientHeight];
            this.#past.render(this.#renderer, this.#scene, this.#camera.three, size);
        } else {
            this.#renderer.render(this.#scene, this.#camera.three);
        }
    }
}

// Adds objects to a scene, to be drawn in this order. View frustum culling is switched off, because
// three.js cannot compute the bounds of objects whose positions are in textures.
function add(scene, objects) {
    objects.forEach((object, order) => {
        object.frustumCulled = false;
        object.renderOrder = order;
        scene.add(object);
    });
}
