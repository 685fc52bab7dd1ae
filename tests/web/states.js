// SPDX-License-Identifier: GPL-3.0-or-later
// The library in WebAssembly, run by node as a page would run it: node states.js GEOMINT.js FONTS [WIDTHxHEIGHTxSCALE]
// reads lines of words, one JSON array each, runs each to its end, and prints the sums of its states and its engines or, with
// a size, the sum of its picture. With "time" for a size it prints the seconds of processor time that a run took.
const crypto = require('crypto'), fs = require('fs');
const [, , program, fonts, size] = process.argv;
delete globalThis.fetch; // emscripten 3.1.6 would take node for a browser
const md5 = bytes => crypto.createHash('md5').update(bytes).digest('hex');

require(fs.realpathSync(program))({wasmBinary: fs.readFileSync(program.replace(/js$/, 'wasm'))}).then(web => {
    const take = web.___wrap_malloc;
    const bytes = (at, count) => web.HEAPU8.slice(at, at + count);
    const text = word => {
        const length = web.lengthBytesUTF8(word) + 1, at = take(length);
        web.stringToUTF8(word, at, length);
        return at;
    };
    const open = words => {
        const at = take(4 * words.length);
        words.forEach((word, i) => { const letters = text(word); web.HEAP32[at / 4 + i] = letters; });
        return web._geomint_open(words.length, at);
    };
    const states = handle => {
        const sums = [], shape = take(8);
        for (let lane = 0; lane < web._geomint_lanes(handle); lane++) {
            // the low half of a count of 64 bits; 0 below 2^32 steps is the end. In parts, as in a page: a function that
            // never ends is never compiled well
            const part = Math.ceil((web._geomint_steps_left(handle, lane) | 0) / 100);
            for (let left; (left = web._geomint_steps_left(handle, lane) | 0) !== 0;) {
                web._geomint_step(handle, lane, left < 0 ? 1000 : Math.min(left, part), 0);
            }
            const state = web._geomint_state(handle, lane, shape, shape + 4);
            sums.push(md5(bytes(state, 8 * web.HEAP32[shape / 4] * web.HEAP32[shape / 4 + 1])));
        }
        return sums.concat(JSON.parse(web.UTF8ToString(web._geomint_text(handle))).map(lane => lane.engine || null));
    };
    const picture = (handle, width, height, scale) => {
        const rgba = take(4 * width * height);
        web._geomint_draw(handle, width, height, scale, rgba);
        const sum = md5(bytes(rgba, 4 * width * height));
        web._free(rgba);
        return [sum];
    };
    web.FS.mkdir('/fonts');
    for (const font of ['DejaVuSans', 'DejaVuSans-Bold', 'DejaVuSansMono']) {
        web.FS.writeFile(`/fonts/${font}.ttf`, fs.readFileSync(`${fonts}/${font}.ttf`));
    }
    for (const line of fs.readFileSync(0, 'utf8').split('\n').filter(Boolean)) {
        const begun = process.cpuUsage(), handle = open(JSON.parse(line));
        const sums = web._geomint_lanes(handle) > 0 ? states(handle) : [web.UTF8ToString(web._geomint_message(handle))];
        const {user, system} = process.cpuUsage(begun), seconds = (user + system) / 1e6;
        console.log(JSON.stringify(!size ? sums : size === 'time' ? seconds : picture(handle, ...size.split('x').map(Number))));
        web._geomint_close(handle);
    }
});
