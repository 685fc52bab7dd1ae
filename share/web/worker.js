// SPDX-License-Identifier: GPL-3.0-or-later
// The program in a worker of the page: carries out what the page orders, advances the lanes in time, draws them into pixels,
// and answers with the state of everything. The page has all controls, and waits for no step.
'use strict';

const SLICE = 12; // milliseconds of steps between two looks at orders
const LATE = 100; // milliseconds that the steps may be late before the clock waits for them

let web, lab = 0; // the program, and its handle
let view = null; // what geomint_view has last described
let shape = {width: 0, height: 0, scale: 1, dark: false}, pixels = 0, capacity = 0;
let playing = false, speed = 1, clock = 0, clockTime = 0, late = false;
const paper = new OffscreenCanvas(1, 1), brush = paper.getContext('2d', {alpha: false, willReadFrequently: true});
let agenda = [], due = []; // changes of a tour at their times, and its stop, {t, lane, text}; those that are to come
let shown = true, stale = false, planned = false; // the page has the last frame; there is something new; a tick will come

const text = at => at ? web.UTF8ToString(at) : null;

// Calls a function of geomint.h. Texts are copied for it, and a list of texts is a count and an array.
function call(name, ...values) {
    const taken = [], copy = word => {
        const length = web.lengthBytesUTF8(word) + 1, at = web.___wrap_malloc(length);
        taken.push(at);
        web.stringToUTF8(word, at, length);
        return at;
    };
    const passed = values.flatMap(value => {
        if (!Array.isArray(value)) {
            return [typeof value === 'string' ? copy(value) : value];
        }
        const places = value.map(copy), at = web.___wrap_malloc(4 * places.length + 4);
        taken.push(at);
        web.HEAP32.set(places, at / 4);
        return [places.length, at];
    });
    const result = web['_geomint_' + name](...passed);
    taken.forEach(at => web._free(at));
    return result;
}

const sentence = handle => text(call('message', handle));
const look = () => { view = JSON.parse(text(call('view', lab))); };
const setClock = () => { clock = performance.now(); clockTime = view.t; };

// ---- time ----

const sign = () => view.backwards ? -1 : 1;
const ahead = () => agenda.filter(({t}) => t >= view.t); // what of a tour is due
const ended = () => view.lanes.every(lane => lane.status !== 'ok');

// Makes a change of the tour; the chosen lane stays.
function change({lane: only, text: words}) {
    const {selected} = view, [key, ...rest] = words.split('='), value = rest.join('=');
    view.lanes.forEach((_, lane) => {
        if (only < 0 || only === lane) {
            call(...key === 'scheme' ? ['switch', lab, lane, value] : ['set', lab, lane, key, value]);
        }
    });
    look();
    select(selected);
}

// Makes the steps that end at or before a time, with the changes of the tour that are due on the way, up to its stop.
function advance(wanted) {
    for (;;) {
        const next = view.backwards ? undefined : due[0];
        const limit = next ? Math.min(wanted, next.t) : wanted;
        call('advance', lab, limit);
        look();
        if (view.backwards) {
            due = ahead();
        }
        if (!next || limit < next.t) {
            return;
        }
        due.shift();
        if (!next.text) {
            playing = false;
            postMessage({stop: true});
            return;
        }
        change(next);
    }
}

// Advances for a slice of time towards the time that is due, in parts that grow while they cost little. After a change of the
// lanes a part begins with the least dt, since the cost of a step is unknown then.
const LEAST = 1e-7;
let part = LEAST;
function step() {
    const begun = performance.now(), from = view.t;
    const goal = clockTime + sign() * speed * (begun - clock) / 1000;
    let now = begun;
    while (playing && sign() * (goal - view.t) > 0 && now - begun < SLICE) {
        const before = view.t, next = sign() * Math.min(sign() * goal, sign() * (before + sign() * part));
        advance(next);
        const cost = performance.now() - now;
        now += cost;
        part *= cost < SLICE / 4 ? 2 : cost > SLICE ? 0.5 : 1;
        if (next === goal) {
            break;
        }
    }
    late = sign() * (goal - view.t) > speed * LATE / 1000 && now - begun >= SLICE;
    if (late) {
        setClock();
    }
    if (ended()) {
        playing = false;
    }
    stale = stale || view.t !== from || !playing;
}

// Draws on the paper, of which the pixels are the program's own memory; returns the sentence of a refusal or null.
function draw(handle, width, height, scale, dark) {
    const size = 4 * width * height;
    if (size > capacity) {
        web._free(pixels);
        pixels = web.___wrap_malloc(size);
        capacity = pixels ? size : 0; // without memory a smaller picture may succeed
    }
    // setting the size, even to the same value, allocates a new bitmap
    if (paper.width !== width || paper.height !== height) {
        Object.assign(paper, {width, height});
    }
    call('theme', handle, dark ? 'dark' : 'light');
    const status = call('draw', handle, width, height, scale, pixels);
    if (status !== 0 && status !== 2) { // 2: a lane has failed, and is drawn
        return sentence(handle);
    }
    brush.putImageData(new ImageData(new Uint8ClampedArray(web.HEAPU8.buffer, pixels, size), width, height), 0, 0);
    return null;
}

function show() {
    const begun = performance.now(), refused = draw(lab, shape.width, shape.height, shape.scale, shape.dark);
    const picture = refused ? null : paper.transferToImageBitmap();
    shown = stale = false;
    postMessage({refused, picture, view, playing, late, cost: performance.now() - begun}, picture ? [picture] : []);
}

function plan() {
    if (!planned && lab && (playing || stale)) {
        planned = true;
        setTimeout(tick, playing && !stale ? 4 : 0);
    }
}

function tick() {
    planned = false;
    if (lab && playing) {
        step();
    }
    if (lab && stale && shown && shape.width > 0) {
        show();
    }
    if (playing || (stale && shown)) {
        plan();
    }
}

// ---- orders of the page ----

// Chooses a lane: the key tab goes from one to the next.
function select(lane) {
    while (lane < view.lanes.length && view.selected !== lane) {
        call('press', lab, 'tab');
        look();
    }
}

// An order of geomint.h for the lanes; returns the sentence of a refusal or "".
function order(name, ...values) {
    const status = call(name, lab, ...values);
    const refusal = status === 0 || status === 2 ? '' : sentence(lab);
    const before = view.t;
    look();
    if (view.t < before || (view.t > before && name !== 'forward')) { // another time is shown; steps leave what is due on the way
        due = ahead();
    }
    part = LEAST;
    setClock();
    stale = true;
    return refusal;
}

const orders = {
    async start({program, wasm, fonts, files}) {
        const unpack = async packed => {
            const letters = atob(packed), bytes = new Uint8Array(letters.length);
            for (let i = 0; i < letters.length; i++) {
                bytes[i] = letters.charCodeAt(i);
            }
            return new Uint8Array(await new Response(
                new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
        };
        const script = URL.createObjectURL(new Blob([await unpack(program)], {type: 'text/javascript'}));
        importScripts(script);
        URL.revokeObjectURL(script);
        web = await geomint({wasmBinary: await unpack(wasm)});
        web.FS.mkdir('/fonts');
        for (const [name, font] of Object.entries(fonts)) {
            web.FS.writeFile(`/fonts/${name}`, await unpack(font));
        }
        for (const [name, content] of Object.entries(files)) {
            web.FS.mkdirTree(`/${name}`.replace(/\/[^/]*$/, ''));
            web.FS.writeFile(`/${name}`, content);
        }
        const scenes = [];
        for (let i = 0, name; (name = text(call('scene_name', i))); i++) {
            scenes.push(name);
        }
        return {scenes};
    },
    // Opens words; refused ones leave what is open as it is.
    open({words, changes}) {
        const opened = call('explore', words);
        if (call('lanes', opened) === 0) {
            const refused = sentence(opened);
            call('close', opened);
            return {refused};
        }
        call('close', lab);
        lab = opened;
        agenda = changes || [];
        due = [...agenda];
        playing = false;
        part = LEAST;
        look();
        setClock();
        stale = true;
        return {view, schemes: JSON.parse(text(call('schemes', lab))), span: Math.abs(view.ahead - view.t)};
    },
    shape(wanted) { shape = wanted; stale = true; },
    shown() { shown = true; },
    // Answers when the page has everything.
    async settled() {
        while (stale || !shown) {
            await new Promise(done => setTimeout(done, 5));
        }
    },
    play(wanted) {
        playing = wanted && !ended();
        setClock();
        stale = true;
    },
    speed(wanted) {
        setClock();
        speed = wanted;
    },
    // Runs ahead to a time of a tour.
    ahead(t) {
        advance(t);
        setClock();
        stale = true;
    },
    order(values) { return order(...values); },
    select(lane) {
        select(lane);
        stale = true;
    },
    grade({tour, step}) {
        const passed = call('grade', lab, tour, step) === 0, verdict = sentence(lab);
        const answer = text(call('answer', lab, tour, step));
        return {passed, verdict, answer, refused: answer ? '' : sentence(lab)};
    },
    // The certificate of a scheme for a problem. Schemes share names: if the first of the name is for another problem, the view's
    // words name the right one, which is then measured on these words.
    certify({name, problem, on}) {
        const measure = words => {
            const handle = call('certify', name, words), certificate = JSON.parse(text(call('text', handle)) || 'null');
            const refused = certificate ? '' : sentence(handle);
            call('close', handle);
            return {certificate, refused};
        };
        const first = measure([]);
        return problem && first.certificate?.for !== problem ? measure(on) : first;
    },
    commands() { call('theme', lab, 'light'); return JSON.parse(text(call('commands', lab))); },
    // The picture of a command line, `geomint render` of these words with these changes.
    async still({words, changes}) {
        const handle = call('open', words), counted = step => [step | 0, Math.floor(step / 2 ** 32)];
        let refused = call('lanes', handle) === 0 ? sentence(handle) : null;
        const give = (...values) => { // a lane that fails, 2, is drawn
            refused = refused ?? ([0, 2].includes(call(...values)) ? null : sentence(handle));
        };
        for (const [, lane, step, change] of changes) {
            give('change', handle, Number(lane), ...counted(Number(step)), change);
        }
        for (let lane = 0; lane < call('lanes', handle); lane++) {
            // the low half of the number of steps left: 0 is the end
            for (let left; refused === null && (left = call('steps_left', handle, lane) | 0) !== 0;) {
                give('step', handle, lane, ...counted(left < 0 ? 1000 : left));
            }
        }
        refused = refused ?? draw(handle, 1280, 720, 1, false);
        call('close', handle);
        return refused ? {refused} : {blob: await paper.convertToBlob()};
    },
};

onmessage = async ({data: {id, name, value}}) => {
    try {
        const answer = await orders[name](value);
        postMessage({id, answer});
        plan();
    } catch (error) {
        postMessage({crash: String(error.message || error)});
    }
};
self.onunhandledrejection = event => postMessage({crash: String(event.reason)});
