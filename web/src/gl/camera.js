// camera.js - the position of the camera, and how pointer, wheel, fingers and keys move it. view.js
// computes what it shows.

import { Matrix4, PerspectiveCamera } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { FIELD_OF_VIEW, UP, fitDistance, turnTo } from '../view.js';

const ZOOM = 0.8; // factor of the distance for one step of the keyboard

export class Camera {
    // The camera object of three.js.
    three = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
    #canvas;
    #controls;

    // `onMove(isHeld)` is called after each move and when it ends; `isHeld`: a pointer or a finger
    // continues it.
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

    // Width / height of the canvas.
    setAspect(aspect) {
        this.three.aspect = aspect;
        this.three.updateProjectionMatrix();
    }

    // Looks at a ball from a direction of length 1.
    look(center, direction, radius) {
        const distance = fitDistance(this.three.aspect) * radius;
        this.#controls.target.set(...center);
        this.three.position.set(...direction).multiplyScalar(distance);
        this.three.position.add(this.#controls.target);
        this.#controls.update();
    }

    // Looks at a ball with its surroundings; `normal` is the direction in which its contents look,
    // or null. A camera behind them goes around the mesh; otherwise it stays on its side.
    frame({ center, radius, normal }) {
        const away = this.three.position.clone().sub(this.#controls.target).normalize();
        const direction = turnTo(away.toArray(), normal);
        this.look(center, direction, radius > 0 ? 1.8 * radius : 0.1);
    }

    // Zooms in (true) or out by one step.
    zoom(nearer) {
        const { target, minDistance, maxDistance } = this.#controls;
        const away = this.three.position.clone().sub(target);
        const distance = away.length() * (nearer ? ZOOM : 1 / ZOOM);
        away.setLength(Math.min(Math.max(distance, minDistance), maxDistance));
        this.three.position.copy(target).add(away);
        this.#controls.update();
    }

    // Position and target: six numbers.
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

    // The matrix of view and projection, column-major, for view.js.
    get matrix() {
        this.three.updateMatrixWorld();
        return new Matrix4().multiplyMatrices(
            this.three.projectionMatrix,
            this.three.matrixWorldInverse,
        ).elements;
    }

    // The mesh is within 1 of the origin; a tight depth range keeps the depth buffer exact.
    setDepthRange() {
        const distance = this.three.position.length();
        const near = 0.02 * this.#controls.getDistance();
        this.three.near = Math.max(distance - 1.1, near);
        this.three.far = distance + 1.1;
        this.three.updateProjectionMatrix();
        this.three.updateMatrixWorld();
    }
}
