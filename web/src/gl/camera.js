// camera.js - the position of the camera, and how pointer, wheel, fingers and keys move it. view.js
// computes what it shows.

import { Matrix4, PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { FIELD_OF_VIEW, UP, fitDistance, turnTo } from '../geometry/view.js';

const ZOOM = 0.8; // factor by which one zoom step changes the distance

export class Camera {
    // The object of three.js that represents the camera.
    three = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
    #canvas;
    #controls;

    // `onMove(isHeld)` is called each time the camera has moved, and when the user ends a drag;
    // `isHeld` says that a pointer or finger is still dragging the camera.
    constructor(canvas, onMove) {
        this.#canvas = canvas;
        this.three.up.set(...UP);
        this.#controls = new OrbitControls(this.three, canvas);
        this.#controls.zoomToCursor = true;
        this.#controls.minDistance = 1e-4;
        this.#controls.maxDistance = 60;
        this.#controls.listenToKeyEvents(canvas);
        let isHeld = false;
        const listen = (type, act) => this.#controls.addEventListener(type, act);
        listen('start', () => {
            isHeld = true;
        });
        listen('change', () => onMove(isHeld));
        listen('end', () => {
            isHeld = false;
            onMove(isHeld);
        });
    }

    // Sets the shape of the picture; `aspect` is width / height of the canvas.
    setAspect(aspect) {
        this.three.aspect = aspect;
        this.three.updateProjectionMatrix();
    }

    // Moves the camera so that it sees a whole ball; `direction` is the vector of length 1 from the
    // ball towards the camera.
    look(center, direction, radius) {
        const distance = fitDistance(this.three.aspect) * radius;
        this.#controls.target.set(...center);
        this.three.position.set(...direction).multiplyScalar(distance);
        this.three.position.add(this.#controls.target);
        this.#controls.update();
    }

    // Moves the camera so that it sees a ball and what is around it. `normal` is the normal of the
    // surface in the ball, or null. If the camera is on the front side of that surface, it keeps
    // its direction; otherwise it moves around to the front side.
    frame({ center, radius, normal }) {
        const away = this.three.position.clone().sub(this.#controls.target).normalize();
        const direction = turnTo(away.toArray(), normal);
        this.look(center, direction, radius > 0 ? 1.8 * radius : 0.1);
    }

    // Zooms in (true) or out (false) by one step.
    zoom(nearer) {
        const { target, minDistance, maxDistance } = this.#controls;
        const away = this.three.position.clone().sub(target);
        const distance = away.length() * (nearer ? ZOOM : 1 / ZOOM);
        away.setLength(Math.min(Math.max(distance, minDistance), maxDistance));
        this.three.position.copy(target).add(away);
        this.#controls.update();
    }

    // Position of the camera and of the point that it looks at: six numbers.
    get numbers() {
        return [...this.three.position.toArray(), ...this.#controls.target.toArray()];
    }

    set numbers(numbers) {
        this.three.position.fromArray(numbers);
        this.#controls.target.fromArray(numbers, 3);
        this.#controls.update();
    }

    // Position and axes of the camera, and the size of the canvas in CSS pixels.
    get view() {
        this.three.updateMatrixWorld();
        const { elements } = this.three.matrixWorld;
        const [right, up, back, position] = [0, 4, 8, 12].map((at) => elements.slice(at, at + 3));
        return { right, up, back, position, height: this.#canvas.clientHeight };
    }

    // The product of the projection and the view matrix, column-major, for view.js.
    get matrix() {
        this.three.updateMatrixWorld();
        return new Matrix4().multiplyMatrices(
            this.three.projectionMatrix,
            this.three.matrixWorldInverse,
        ).elements;
    }

    // Returns the ray from the camera through a place on the screen, which is given in clip coordinates
    // from -1 to 1: {origin, direction}.
    rayAt(x, y) {
        this.three.updateMatrixWorld();
        const origin = this.three.position;
        const direction = new Vector3(x, y, 0.5).unproject(this.three).sub(origin).normalize();
        return { origin: origin.toArray(), direction: direction.toArray() };
    }

    // Sets the near and the far plane close to what is drawn, because the depth buffer is more exact
    // if these planes are close together. The mesh lies within distance 1 of the origin, and other
    // lines within distance `reach`.
    setDepthRange(reach) {
        const distance = this.three.position.length();
        const near = 0.02 * this.#controls.getDistance();
        const most = 0.1 + Math.max(reach, 1);
        this.three.near = Math.max(distance - most, near);
        this.three.far = distance + most;
        this.three.updateProjectionMatrix();
        this.three.updateMatrixWorld();
    }
}
