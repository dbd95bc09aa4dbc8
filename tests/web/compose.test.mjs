// Tests that server/compose.yaml is well formed, and that what it names exists: in the container's
// image, among the options of hedged, or in the folder of the file.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { program } from './daemon.mjs';

const require = createRequire(new URL('../../web/package.json', import.meta.url));
const yaml = require('js-yaml');

const folder = fileURLToPath(new URL('../../server', import.meta.url));
const compose = yaml.load(readFileSync(path.join(folder, 'compose.yaml'), 'utf8'));
const service = compose.services.hedged;
const image = readFileSync(path.join(folder, service.build, 'Dockerfile'), 'utf8');

// Returns the arguments of the last instruction of this name in the Dockerfile, on one line.
function instruction(name) {
    const found = image.replaceAll(/\\\n\s*/g, '').match(new RegExp(`^${name} .*$`, 'gm'));
    assert.ok(found, `the Dockerfile has no ${name}`);
    return found.at(-1).slice(name.length + 1);
}

const settings = Object.fromEntries(instruction('ENV').split(' ').map((pair) => pair.split('=')));

test('it has one service, and only keys that Compose knows', () => {
    assert.deepEqual(Object.keys(compose).sort(), ['services', 'volumes']);
    assert.deepEqual(Object.keys(compose.services), ['hedged']);
    const known = ['build', 'cap_drop', 'environment', 'healthcheck', 'image', 'ports', 'read_only', 'restart',
        'security_opt', 'stop_grace_period', 'volumes'];
    assert.deepEqual(Object.keys(service).filter((key) => !known.includes(key)), []);
    const checks = ['interval', 'retries', 'start_period', 'test', 'timeout'];
    assert.deepEqual(Object.keys(service.healthcheck).sort(), checks);
    for (const time of [...checks.filter((key) => /period|interval|timeout/.test(key)).map(
        (key) => service.healthcheck[key]), service.stop_grace_period]) {
        assert.match(time, /^\d+s$/);
    }
});

test('its variables are settings of hedged, which takes them together with those of the image', () => {
    const environment = { ...settings, ...service.environment };
    const help = execFileSync(program, ['--help'], { encoding: 'utf8' });
    for (const name of Object.keys(environment)) {
        assert.match(help, new RegExp(`^ +${name}$`, 'm'));
    }
    const lines = execFileSync(program, ['--print-config'], { encoding: 'utf8', env: environment }).split('\n');
    for (const [name, value] of Object.entries(environment)) {
        assert.ok(lines.includes(`${name.slice(6).toLowerCase().replaceAll('_', '-')} = ${value}`), name);
    }
});

test('its health check is one of hedged, and the same as that of the image', () => {
    const [how, ...command] = service.healthcheck.test;
    assert.equal(how, 'CMD');
    assert.equal(command[0], JSON.parse(instruction('ENTRYPOINT'))[0]);
    assert.match(execFileSync(program, ['--help'], { encoding: 'utf8' }), new RegExp(`^  ${command[1]} `, 'm'));
    assert.deepEqual(JSON.parse(instruction('HEALTHCHECK').replace(/^.*CMD /, '')), command);
});

test('its volume is where the image keeps meshes, and its port where hedged listens', () => {
    const [volume, where] = service.volumes[0].split(':');
    assert.equal(service.volumes.length, 1);
    assert.ok(volume in compose.volumes);
    assert.equal(where, instruction('VOLUME'));
    assert.equal(settings.HEDGE_STORE, `sqlite:${where}`);
    const [host, published, inside] = service.ports[0].split(':');
    assert.equal(host, '127.0.0.1');
    assert.ok(Number(published) > 0);
    assert.equal(inside, instruction('EXPOSE'));
    assert.equal(settings.HEDGE_LISTEN, `0.0.0.0:${inside}`);
    assert.ok(existsSync(path.join(folder, service.build, 'Makefile')));
});
