// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a lesson: controls for what worker.js runs. What a text says is set as text, never as HTML.
'use strict';

const at = id => document.getElementById(id);
const lesson = JSON.parse(at('view').textContent), parts = JSON.parse(at('parts').textContent);
const canvas = at('picture'), paper = canvas.getContext('bitmaprenderer', {alpha: false}), dark = matchMedia('(prefers-color-scheme: dark)');
// the lanes' colours of pictures, light and dark
const colours = [['#0379db', '#83d1ff'], ['#ec5100', '#ffa226'], ['#1aa770', '#72ecb1'], ['#ba2787', '#d87fa7'],
    ['#7a0102', '#6272fa'], ['#03624a', '#87814a']];
const most = 6; // lanes

let view = null, schemes = [], words = lesson.words.length > 0 ? lesson.words : ['kepler'], playing = false, speed = 1, chosen = 0, scene = '', forking = false, started = false;
let late = false, due = null; // steps are late; all that is shown will be renewed
let theme = null; // what was chosen instead of the system's

function make(name, properties, ...inside) {
    const {data, ...rest} = properties || {}, element = Object.assign(document.createElement(name), rest);
    Object.entries(data || {}).forEach(([key, value]) => element.setAttribute(key, value));
    element.append(...inside);
    return element;
}

// ---- the program ----

let worker, waiting = new Map(), number = 0, patience;

function ask(name, value) {
    return new Promise((resolve, reject) => {
        waiting.set(++number, {resolve, reject});
        worker?.postMessage({id: number, name, value});
        patience = patience || worker && setTimeout(() => complain('The program has been busy for ten seconds. You can wait for it.'), 10000);
    });
}

// What waited for a program that was ended goes no further, and says nothing.
const ended = new Error('the program was started again');
addEventListener('unhandledrejection', event => event.reason === ended && event.preventDefault());

// Gives the orders of a control one at a time: of those that come meanwhile the last one counts.
function latest(act) {
    let wanted = null;
    return async value => {
        const first = wanted === null;
        wanted = value;
        while (first && wanted !== null) {
            const now = wanted;
            await act(now).catch(() => { wanted = now; });
            wanted = wanted === now ? null : wanted;
        }
    };
}

// Shows a sentence and a way to start again.
function complain(sentence) {
    at('crash-text').textContent = sentence;
    at('crash').hidden = false;
    at('revive').focus();
}

function crash(reason) {
    worker.terminate();
    worker = null;
    rest();
    at('sheet').close(); // what is open there would keep the way on from being used
    setReady(false);
    complain(`The program has stopped: ${reason}.`);
}

// The program has answered, or none runs.
function rest() {
    at('crash').hidden = true;
    clearTimeout(patience);
    patience = null;
}

// Controls act only if there is a view.
const setReady = ready => document.querySelectorAll('header, main').forEach(part => { part.inert = !ready; });

async function begin() {
    rest();
    setReady(false);
    view = null;
    worker?.terminate();
    waiting.forEach(({reject}) => reject(ended));
    waiting = new Map();
    const source = URL.createObjectURL(new Blob([at('worker').textContent], {type: 'text/javascript'}));
    worker = new Worker(source);
    worker.onerror = event => crash(event.message || 'it could not be started');
    worker.onmessage = ({data}) => {
        rest();
        if (data.crash) {
            crash(data.crash);
        } else if (data.id) {
            waiting.get(data.id).resolve(data.answer);
            waiting.delete(data.id);
        } else if (data.stop) {
            stopOfTour();
        } else {
            show(data);
        }
    };
    const {scenes} = await ask('start', {...parts, files: lesson.files});
    URL.revokeObjectURL(source);
    if (at('scene').length === 0) {
        at('scene').append(make('option', {value: ''}, '…'), ...scenes.map(name => make('option', {value: name}, name)));
    }
    shape();
    const again = started;
    started = true;
    if (again || !await openHash()) {
        const refused = await (at('tour').hidden ? open(words) : goTo(stepNumber));
        if (refused) { // the controls need some view
            await open(['kepler']);
            say(refused, true);
        }
    }
    setReady(true);
}

// Gives an order of geomint.h, and shows the sentence of its refusal.
async function order(...values) {
    const refused = await ask('order', values);
    if (refused) {
        say(refused, true);
    }
    return !refused;
}

// ---- the picture ----

function isDark() {
    return theme === null ? dark.matches : theme;
}

function shape() {
    const ratio = Math.min(window.devicePixelRatio || 1, 4), box = canvas.getBoundingClientRect();
    document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';
    const width = Math.max(64, Math.round(box.width * ratio)), height = Math.max(64, Math.round(box.height * ratio));
    return ask('shape', {width, height, scale: ratio * Math.min(Math.max(box.width / 560, 0.7), 1), dark: isDark()});
}

function say(sentence, bad) {
    const line = make('p', {className: `${bad ? 'bad' : ''} ${sentence.includes('\n') ? 'lines' : ''}`, textContent: sentence});
    at('notice').replaceChildren(line);
    clearTimeout(say.end);
    say.end = setTimeout(() => line.remove(), bad ? 12000 : 7000);
}

const digits = (value, count = 5) => value === null || value === undefined ? '–' : Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3)
    ? value.toExponential(Math.min(count - 1, 2)).replace('e+', 'e').replace('-', '−').replace('e-', 'e−') : String(+value.toPrecision(count)).replace('-', '−');

const failures = new Set(); // the sentences that were shown

function show(news) {
    if (news.refused) {
        say(news.refused, true);
    } else {
        if (canvas.width !== news.picture.width || canvas.height !== news.picture.height) { // setting it lays out the page anew
            Object.assign(canvas, {width: news.picture.width, height: news.picture.height});
        }
        paper.transferFromImageBitmap(news.picture);
    }
    document.body.dataset.frames = 1 + Number(document.body.dataset.frames || 0);
    document.body.dataset.cost = news.cost.toFixed(1);
    view = news.view;
    playing = news.playing;
    late = news.late;
    if (playing) { // digits that change with every frame cannot be read
        due ??= setTimeout(showAll, 100);
    } else {
        showAll();
    }
    ask('shown');
}

function showAll() {
    clearTimeout(due);
    due = null;
    if (!view) { // another program is loaded
        return;
    }
    at('play').textContent = playing ? '❚❚' : '▶';
    at('play').setAttribute('aria-label', playing ? 'pause' : 'play');
    at('reverse').setAttribute('aria-pressed', view.backwards);
    at('overlay').setAttribute('aria-pressed', view.overlaid);
    at('clock').textContent = `t = ${digits(view.t)}`;
    at('clock').title = view.unit;
    const step = Number(view.parameters.find(({key}) => key === 'dt')?.value); // a long step takes its time at this speed
    at('speed').textContent = `${speed}/s${!playing ? '' : late ? ', late' : step > 2 * speed ? `, a step in ${digits(step / speed, 2)} s` : ''}`;
    const line = at('line');
    line.max = Math.max(view.reach, view.passed, Number.MIN_VALUE);
    line.setAttribute('aria-valuetext', at('clock').textContent);
    if (document.activeElement !== line || playing) {
        line.value = view.passed;
    }
    showLanes();
    showValues();
    showParameters();
    showUsed();
    view.lanes.forEach(lane => {
        if (lane.message && !failures.has(lane.message)) {
            failures.add(lane.message);
            say(lane.message, true);
        }
    });
    canvas.style.touchAction = view.in_space ? 'none' : 'pan-y'; // a vertical drag scrolls a phone's page
    canvas.setAttribute('aria-label', `${view.title}: ${view.lanes.map(lane => lane.title).join(', ')} at t = ${digits(view.t)}`);
}

// Makes the elements of a list anew only if its description has changed, so that scrolling stays. The focus stays on the
// element of the same name, or of the same place.
function renew(element, description, build) {
    const key = JSON.stringify(description);
    if (element.dataset.of !== key) {
        element.dataset.of = key;
        const all = () => [...element.querySelectorAll('button:not([hidden]), select, input')], place = all().indexOf(document.activeElement);
        const nameOf = one => one.id + one.textContent + one.getAttribute('aria-label'), name = place < 0 ? '' : nameOf(document.activeElement);
        element.replaceChildren(...build());
        if (place >= 0) {
            (all().find(one => nameOf(one) === name) || all()[Math.min(place, all().length - 1)])?.focus({preventScroll: true});
        }
    }
}

// ---- lanes and values ----

const colour = lane => colours[lane % colours.length][isDark() ? 1 : 0];

function showLanes() {
    const list = view.lanes.map(lane => [lane.title, lane.status, lane.message]);
    renew(at('lanes'), [list, isDark()], () => view.lanes.map((lane, i) => {
        const pick = make('button', {className: 'lane', onclick: () => select(i), title: 'choose this lane (1 to 6)',
            data: {style: `--colour: ${colour(i)}`}}, lane.title);
        if (lane.status !== 'ok') {
            pick.append(make('span', {className: 'state'}, lane.message || lane.status));
        }
        return make('li', null, pick,
            make('button', {textContent: 'i', title: 'formula and reference (i)', onclick: () => explain(lane.scheme), data: {'aria-label': `about ${lane.title}`}}),
            make('button', {textContent: '×', title: 'remove this lane (x)', hidden: view.lanes.length === 1, onclick: () => order('remove', i), data: {'aria-label': `remove ${lane.title}`}}));
    }));
    at('lanes').querySelectorAll('.lane').forEach((pick, i) => pick.setAttribute('aria-pressed', i === view.selected));
}

const select = lane => ask('select', lane);

function showValues() {
    const table = at('values'), turned = view.turned ? [{key: 'from_start', title: 'from start', unit: ''}] : [];
    const rows = [...view.observables, ...turned];
    renew(table, [rows, view.lanes.map(lane => lane.title), isDark()], () => [
        make('thead', null, make('tr', null, ...view.lanes.map((lane, i) => make('th', {scope: 'col', data: {style: `--colour: ${colour(i)}`}}, lane.title)))),
        make('tbody', null, ...rows.flatMap(row => [
            make('tr', null, make('th', {colSpan: view.lanes.length, scope: 'rowgroup'}, row.title + (row.unit && row.unit !== '1' ? `, ${row.unit}` : ''))),
            make('tr', null, ...view.lanes.map(() => make('td')))]))]);
    rows.forEach((row, r) => view.lanes.forEach((lane, i) => {
        table.tBodies[0].rows[2 * r + 1].cells[i].textContent = digits(row.key === 'from_start' ? lane.from_start : lane.values[row.key],
            view.lanes.length > 3 ? 3 : 5);
    }));
}

// ---- parameters ----

function control(parameter, i) {
    const {key} = parameter, name = `parameter-${key}`;
    const label = make('label', {htmlFor: name, textContent: key, title: parameter.help});
    const set = async (value, field) => {
        if (!await order('set', view.selected, key, value)) {
            field.value = view.parameters.find(other => other.key === key).value;
        }
    };
    const focus = {onfocus: () => choose(i)};
    if (parameter.choices.length > 0) {
        const pick = make('select', {id: name, className: 'full', title: parameter.help, ...focus}, ...parameter.choices.map(choice => make('option', null, choice)));
        pick.onchange = () => set(pick.value, pick);
        return [label, pick];
    }
    const field = make('input', {id: name, spellcheck: false, title: parameter.help, autocomplete: 'off', ...focus});
    field.onchange = () => set(field.value, field);
    if (parameter.position === null) {
        field.className = 'full';
        return [label, field];
    }
    const slider = make('input', {type: 'range', min: 0, max: 1, step: 0.001, ...focus, data: {'aria-label': `${key}: ${parameter.help}`}});
    const slide = latest(place => order('slide', view.selected, key, place));
    slider.oninput = () => slide(Number(slider.value));
    return [label, slider, field];
}

function showParameters() {
    const box = at('parameters');
    renew(box, view.parameters.map(({key, choices, position, help}) => [key, choices, position === null, help]), () =>
        view.parameters.map((parameter, i) => make('div', {className: 'row'}, ...control(parameter, i))));
    chosen = Math.min(chosen, Math.max(view.parameters.length - 1, 0));
    view.parameters.forEach((parameter, i) => {
        const row = box.children[i], field = row.querySelector('select, input:not([type=range])'), slider = row.querySelector('[type=range]');
        row.classList.toggle('chosen', i === chosen);
        if (document.activeElement !== field || field.tagName === 'SELECT') {
            field.value = parameter.value;
        }
        if (slider && !slider.matches(':active')) {
            slider.value = parameter.position;
        }
        if (slider) {
            slider.setAttribute('aria-valuetext', parameter.value);
        }
    });
}

function choose(i) {
    const count = view.parameters.length;
    chosen = count > 0 ? (i + count) % count : 0;
    showParameters();
    if (count > 0) {
        at('parameters').children[chosen].scrollIntoView({block: 'nearest'});
    }
}

// Moves the chosen parameter: a slider by a part of its range, a list by an entry.
function move(direction, fine) {
    const parameter = view.parameters[chosen];
    if (!parameter) {
        return;
    }
    const {key, choices, value, position} = parameter;
    if (choices.length > 0) {
        order('set', view.selected, key, choices[(choices.indexOf(value) + direction + choices.length) % choices.length]);
    } else if (position !== null) {
        order('slide', view.selected, key, Math.min(Math.max(position + direction * (fine ? 0.005 : 0.05), 0), 1));
    } else {
        say(`${key} has no range: type its value.`);
    }
}

// ---- schemes ----

function showSchemes() {
    const sought = at('find').value.trim().toLowerCase();
    const fits = schemes.filter(scheme => [scheme.scheme, scheme.title, ...scheme.claims].join(' ').toLowerCase().includes(sought));
    // the exact name first, then those that begin so
    const rankOf = name => name.toLowerCase() === sought ? 0 : name.toLowerCase().startsWith(sought) ? 1 : 2;
    const rank = ({scheme, title}) => Math.min(rankOf(scheme), rankOf(title));
    fits.sort((a, b) => rank(a) - rank(b));
    renew(at('schemes'), fits.map(one => [one.scheme, one.for]), () => fits.map(scheme => make('li', null,
        make('button', {className: 'scheme', onclick: event => take(scheme.scheme, event.shiftKey || forking), data: {'data-scheme': scheme.scheme}, title: 'switch the chosen lane to it; with shift: fork'},
            `${scheme.title}${scheme.order ? `, order ${scheme.order}` : ''}`,
            make('span', {className: 'claims'}, scheme.claims.join(', ') || 'claims nothing but its order')),
        make('button', {className: 'fork', textContent: 'fork', onclick: () => take(scheme.scheme, true), title: 'fork: a copy of the lane continues with it', data: {'aria-label': `fork to ${scheme.title}`}}))));
    showUsed();
}

function showUsed() {
    for (const button of at('schemes').querySelectorAll('.scheme')) {
        button.setAttribute('aria-pressed', view !== null && view.lanes[view.selected].scheme === button.dataset.scheme);
    }
}

async function take(scheme, forks) {
    const free = !forks || view.lanes.length < most;
    forking = false;
    if (free ? await order(forks ? 'fork' : 'switch', view.selected, scheme) : say(`There are at most ${most} lanes.`, true)) {
        at('find').value = '';
        showSchemes();
    }
}

function seek(forks) {
    forking = forks;
    say(forks ? 'Choose a scheme: a copy of the lane continues with it.' : 'Choose a scheme: the lane continues with it.');
    at('find').focus();
    at('find').scrollIntoView({block: 'center'});
}

async function explain(name) {
    const scheme = schemes.find(other => other.scheme === name) || {title: name, claims: []};
    const on = named(words).filter(word => !/^(scheme|dt)=/.test(word));
    const {certificate, refused} = await ask('certify', {name, problem: scheme.for, on}), order = certificate?.measured_order;
    const measured = Object.entries(certificate?.properties || {}).filter(([, claim]) => claim.measured);
    sheet(scheme.title, make('pre', null, scheme.formula || name), make('p', null, scheme.reference || ''),
        make('p', null, refused || (order === null && measured.length === 0 ? `Not measured here; in a terminal, geomint certify ${name} measures it.`
            : `Measured: order ${digits(order, 4)}, and these defects.`)),
        make('table', {id: 'certificate'}, ...measured.map(([words, {claimed, defect, tolerance}]) => make('tr', null, make('th', {scope: 'row'}, words),
            make('td', null, digits(defect, 2)), make('td', null, !claimed ? 'not claimed' : defect <= tolerance ? 'holds' : 'is broken')))),
        make('p', {className: 'soft'}, `For ${scheme.for || 'these equations'}. Order ${scheme.order ?? 'unknown'}. ${scheme.claims.length > 0 ? `Claims: ${scheme.claims.join(', ')}.` : ''}`));
}

function sheet(title, ...inside) {
    at('sheet-title').textContent = title;
    at('sheet-text').replaceChildren(...inside);
    if (!at('sheet').open) {
        at('sheet').showModal();
        at('sheet').scrollTop = 0;
    }
}

// ---- opening views ----

// Words of a typed line: a blank ends a word if another one, NAME=, follows it outside of parentheses and quotes.
function split(line) {
    const found = [];
    let depth = 0, quote = '', word = '';
    [...line.trim()].forEach((letter, i, all) => {
        const rest = letter === ' ' ? all.slice(i + 1, i + 65).join('') : '';
        if (letter === quote) {
            quote = '';
        } else if (!quote && (letter === '"' || letter === "'") && /(^|=)$/.test(word)) {
            quote = letter;
        } else if (letter === ' ' && !quote && depth <= 0 && (/^\s*[\p{L}_][\p{L}\p{N}_-]*=(?!=)/u.test(rest) || !word.includes('='))) {
            found.push(word);
            word = '';
        } else {
            depth += letter === '(' ? 1 : letter === ')' ? -1 : 0;
            word += letter;
        }
    });
    return [...found, word];
}

const typed = list => list.map(word => / /.test(word) && !word.includes('=') ? `"${word}"` : word).join(' ');

// A formula alone is of a system.
const named = list => /^(H|L|V|S|rate)=/.test(list[0] || '') ? ['system', ...list] : list;

async function open(list, changes) {
    const wanted = named(list.filter(Boolean));
    const opened = await ask('open', {words: wanted, changes});
    if (opened.refused) {
        return opened.refused;
    }
    ({view, schemes} = opened);
    setSpeed(opened.span / 6);
    words = list;
    playing = false;
    failures.clear();
    const file = lesson.files[wanted[0]] !== undefined || wanted[0] === 'system';
    at('scene').value = scene = file ? '' : wanted[0];
    at('words').value = typed(wanted);
    at('title').textContent = list === lesson.words || lesson.steps ? lesson.title : view.title;
    document.title = at('title').textContent;
    fault('');
    showSchemes();
    showAll();
    return '';
}

function fault(sentence) {
    at('fault').textContent = sentence;
    at('fault').hidden = !sentence;
    at('words').setAttribute('aria-invalid', Boolean(sentence));
    const [first, quoted, caret] = sentence.split('\n');
    if (caret) { // the place of the mistake in the field: in the value of the key that the sentence names
        const before = quoted.slice(4, caret.indexOf('^')), line = at('words').value, key = /^in (\S+=)/.exec(first)?.[1] || '';
        const value = Math.max(` ${line}`.indexOf(` ${key}`), 0) + key.length;
        const place = Math.max(line.indexOf(quoted.trim().replace(/\?/g, '').slice(0, 20), value), 0);
        at('words').setSelectionRange(place + before.length, place + before.length + 1);
    }
}

at('formula').onsubmit = async event => {
    event.preventDefault();
    const refused = await open(split(at('words').value));
    fault(/^there is no scene|^which scene/.test(refused) ? `${refused}; a formula is H=p^2/2 - cos(q) q=1 p=0, without blanks beside =` : refused);
};
at('scene').onchange = async () => {
    const refused = at('scene').value && await open([at('scene').value]);
    at('scene').value = scene;
    say(refused || view.title, refused);
};

// lesson.html#kepler&scheme=verlet,rk4 opens another view. Returns true if there is one that is not refused.
async function openHash() {
    const hash = location.hash.slice(1);
    if (!hash) {
        return false;
    }
    let list;
    try {
        list = hash.split('&').map(decodeURIComponent);
    } catch (error) { // list has no value then
    }
    const refused = list ? await open(list) : 'the words after # are not percent-encoded';
    if (refused) {
        say(`The link was not opened: ${refused}`, true);
    }
    at('tour').hidden = at('tour').hidden || !refused;
    return !refused;
}
addEventListener('hashchange', () => {
    if (location.hash.length <= 1) {
        location.reload();
    } else if (view) { // else the page is still opening, and will read it
        openHash();
    }
});

// ---- time ----

const play = on => { playing = on; ask('play', on); showAll(); };
const pauseAnd = async (...values) => { await ask('play', false); return order(...values); };
// Sets the nearest of the speeds 1, 2, 5, 10 ... times a power of ten, or the next one to it.
function setSpeed(wanted, direction = 0) {
    const place = Math.round(3 * Math.log10(wanted > 0 ? wanted : 1)) + direction, tens = Math.floor(place / 3);
    speed = Number(`${[1, 2, 5][place - 3 * tens]}e${tens}`);
    ask('speed', speed);
}
const faster = direction => { setSpeed(speed, direction); showAll(); };
at('play').onclick = () => play(!playing);
at('back').onclick = () => pauseAnd('back');
at('forward').onclick = () => pauseAnd('forward');
at('reverse').onclick = () => order('reverse');
at('restart').onclick = () => { failures.clear(); order('restart'); };
at('slower').onclick = () => faster(-1);
at('faster').onclick = () => faster(1);
at('line').oninput = () => pauseAnd('visit', Number(at('line').value));
at('add').onclick = () => order('press', 'c');
at('overlay').onclick = () => order('press', 'o');
at('undo').onclick = () => order('undo');
at('find').oninput = showSchemes;
at('find').onkeydown = event => {
    const first = at('schemes').querySelector('.scheme'), sought = at('find').value.trim();
    if (event.key === 'Enter' && sought) { // a word that fits none may be a user-defined scheme
        take(first ? first.dataset.scheme : sought, event.shiftKey || forking);
    }
};

// ---- the pointer: a press or a drag in a plane starts an orbit there; in space it turns the camera ----

const SLOP = 6; // what a press moves at most, in pixels
let held = null, drags = false;
const pointAt = latest(places => ask('order', ['point', ...places]));

function point(event) {
    const box = canvas.getBoundingClientRect(), scale = canvas.width / box.width;
    if (view.in_space) {
        const degrees = 180 / box.width, turn = [degrees * (held.clientX - event.clientX), degrees * (event.clientY - held.clientY)];
        held = event;
        ask('order', ['look', ...turn, 1]);
    } else {
        pointAt([(event.clientX - box.left) * scale, (event.clientY - box.top) * scale]);
    }
}

// Neither other buttons nor a second finger act. A finger that moves upwards or downwards in a plane scrolls the page, so a
// press acts at its end, and a drag when it is clear that it is one.
canvas.addEventListener('pointerdown', event => {
    if (event.isPrimary && event.button === 0) {
        held = event;
        drags = false;
        canvas.setPointerCapture(event.pointerId);
    }
});
const distance = event => [event.clientX - held.clientX, event.clientY - held.clientY].map(Math.abs);
canvas.addEventListener('pointermove', event => {
    if (held && view && event.isPrimary) {
        const [x, y] = distance(event), scrolls = event.pointerType === 'touch' && !view.in_space && y >= x;
        drags = drags || (Math.max(x, y) > SLOP && !scrolls);
        if (drags) {
            point(event);
        }
    }
});
canvas.addEventListener('pointerup', event => {
    if (held && view && event.isPrimary && !view.in_space && !drags && Math.max(...distance(event)) <= SLOP) {
        point(event);
    }
    held = event.isPrimary ? null : held;
});
canvas.addEventListener('pointercancel', event => { held = event.isPrimary ? null : held; });
canvas.addEventListener('wheel', event => {
    if (view.in_space) {
        event.preventDefault();
        ask('order', ['look', 0, 0, event.deltaY < 0 ? 1.1 : 1 / 1.1]);
    }
}, {passive: false});

// ---- what leaves the page ----

// The words of a command line, which quotes some of them for a shell.
const unquoted = line => line.match(/(?:'[^']*'|\\.|[^\s'\\])+/g).map(word => word.replace(/'([^']*)'|\\(.)/g, '$1$2'));

at('copy').onclick = async () => {
    const {picture, explorer} = await ask('commands');
    const address = `${location.href.split('#')[0]}#${unquoted(explorer).slice(1).map(encodeURIComponent).join('&').replace(/%2C/g, ',').replace(/%3D/g, '=')}`;
    let copied = true;
    try {
        await navigator.clipboard.writeText(`${address}\n${picture}`);
    } catch (error) {
        copied = false;
    }
    sheet(copied ? 'Copied' : 'Link and command line', make('p', null, 'A link that opens these schemes and parameters from the start:'), make('pre', {id: 'link'}, address),
        make('p', null, 'The command line that makes this picture:'), make('pre', {id: 'command'}, picture));
};

function download(name, blob) {
    const address = URL.createObjectURL(blob);
    make('a', {href: address, download: name}).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
}

at('save').onclick = async () => {
    const words = unquoted((await ask('commands')).picture).slice(2), option = words.findIndex(word => word.startsWith('--'));
    const list = words[words.indexOf('--changes') + 1];
    const changes = words.includes('--changes') ? list.split(/,(?=\d+:\d+:)/).map(change => /^(\d+):(\d+):(.*)$/.exec(change)) : [];
    const still = await ask('still', {words: words.slice(0, option), changes});
    if (still.blob) {
        download(`${view.scene}.png`, still.blob);
    }
    say(still.refused || `${view.scene}.png is saved.`, still.refused);
};

let recorder = null;
at('record').onclick = () => {
    if (recorder) {
        recorder.stop();
        return;
    }
    if (!window.MediaRecorder || !canvas.captureStream) {
        say('This browser records no movies.', true);
        return;
    }
    const pieces = [];
    recorder = new MediaRecorder(canvas.captureStream(30), {videoBitsPerSecond: 8e6});
    recorder.ondataavailable = event => pieces.push(event.data);
    recorder.onstop = () => {
        const movie = new Blob(pieces, {type: 'video/webm'});
        if (movie.size > 0) {
            download(`${view.scene}.webm`, movie);
        } else {
            say('The movie has no picture yet: record for longer.', true);
        }
        recorder = null;
        at('record').setAttribute('aria-pressed', false);
    };
    recorder.start();
    at('record').setAttribute('aria-pressed', true);
    say('Recording what is seen; the button again ends it.');
};

// ---- a lesson in steps ----

let stepNumber = 0, answered = true;

async function goTo(wanted) {
    const steps = lesson.steps, index = Math.min(Math.max(wanted, 0), steps.length - 1), step = steps[index];
    let first = index;
    while (!steps[first].show && first > 0) {
        first--;
    }
    const begins = first < index ? steps[index - 1].until : null;
    const plan = steps.slice(first, index + 1).flatMap(one => one.changes);
    stepNumber = index;
    answered = !step.ask || step.exercise;
    at('tour').hidden = false;
    const refused = await open(steps[first].show, [...plan, {t: step.until, lane: -1, text: null}]);
    if (stepNumber !== index) { // another step was chosen meanwhile
        return;
    }
    if (refused) {
        say(refused, true);
    } else if (begins !== null) {
        await ask('ahead', begins);
    }
    const span = refused ? 0 : Math.abs(step.until - (begins ?? view.t));
    if (span > 0 && step.seconds > 0) {
        setSpeed(span / step.seconds);
    }
    showStep(false);
    if (answered && !refused) {
        play(true);
    }
    return refused;
}

function showStep(over) {
    const step = lesson.steps[stepNumber], text = (title, words, name) => words
        ? [make('p', {className: name || ''}, title ? make('b', null, `${title} `) : '', words)] : [];
    at('tour-place').textContent = `step ${stepNumber + 1} of ${lesson.steps.length}`;
    at('tour-title').textContent = step.title;
    at('tour-text').replaceChildren(...text('', step.say), ...text('', step.ask, 'ask'),
        ...answered ? [...text('', step.ask && !step.exercise && step.answer), ...text('Watch:', step.watch), ...over || !step.ask ? text('Try:', step.try) : []] : [],
        ...answered && step.study ? text('In a terminal:', `geomint ${step.study}`) : []);
    at('grade').hidden = !step.exercise;
    at('hand-in').hidden = true;
    at('next').textContent = answered ? 'next' : 'answer';
    at('next').disabled = answered && stepNumber === lesson.steps.length - 1;
    at('earlier').disabled = stepNumber === 0;
}

// Shows the verdict on the lanes as they are now, and returns the answer, null if there is none.
async function grade() {
    const index = stepNumber, step = lesson.steps[index];
    const {passed, verdict, answer, refused} = await ask('grade', {tour: lesson.tour, step: index + 1});
    if (stepNumber !== index) { // another step was chosen meanwhile
        return null;
    }
    showStep(false);
    at('tour-text').append(make('p', {id: 'verdict', className: passed ? 'ask' : '', textContent: verdict}),
        make('p', null, (passed ? step.answer : answer && step.hint) || ''), refused === verdict ? '' : refused);
    at('hand-in').hidden = !answer;
    at('grade').scrollIntoView({block: 'nearest'});
    return answer;
}

async function handIn() {
    const name = `${lesson.tour.replace(/\.tour$/, '')}-${stepNumber + 1}.answer`, answer = await grade();
    if (answer) {
        download(name, new Blob([answer]));
    }
}
at('grade').onclick = grade;
at('hand-in').onclick = handIn;

function stopOfTour() {
    playing = false;
    if (lesson.steps) {
        showStep(true);
    }
}

function next() {
    if (!answered) {
        answered = true;
        showStep(false);
        play(true);
    } else if (stepNumber < lesson.steps.length - 1) {
        goTo(stepNumber + 1);
    }
}
at('next').onclick = next;
at('earlier').onclick = () => goTo(stepNumber - 1);
at('again').onclick = () => goTo(stepNumber);

// ---- keys ----

const inTour = act => () => lesson.steps && !at('tour').hidden && act();
const keys = {
    ' ': ['pause and resume', () => play(!playing)],
    '.': ['one step', () => at('forward').click()],
    ',': ['one step back', () => at('back').click()],
    '[': ['slower', () => faster(-1)],
    ']': ['faster', () => faster(1)],
    'PageUp': ['an earlier snapshot', () => pauseAnd('press', 'PgUp')],
    'PageDown': ['a later snapshot', () => pauseAnd('press', 'PgDn')],
    'Home': ['the first snapshot', () => pauseAnd('press', 'Home')],
    'End': ['the last snapshot', () => pauseAnd('press', 'End')],
    'B': ['turn time, dt to −dt', () => at('reverse').click()],
    'r': ['restart', () => at('restart').click()],
    's': ['switch the scheme', () => seek(false)],
    'f': ['fork: a copy continues with another scheme', () => seek(true)],
    'i': ['formula and reference', () => explain(view.lanes[view.selected].scheme)],
    'c': ['add a lane', () => at('add').click()],
    'x': ['remove the chosen lane', () => order('remove', view.selected)],
    'o': ['lanes in one panel, or side by side', () => at('overlay').click()],
    'ArrowUp': ['the parameter above', () => choose(chosen - 1)],
    'ArrowDown': ['the parameter below', () => choose(chosen + 1)],
    'ArrowLeft': ['make it smaller', () => move(-1, false)],
    'ArrowRight': ['make it larger', () => move(1, false)],
    '-': ['a little smaller', () => move(-1, true)],
    '+': ['a little larger', () => move(1, true)],
    'Enter': ['type its value', () => at('parameters').children[chosen]?.querySelector('select, input:not([type=range])').focus()],
    'Backspace': ['set it to its default', () => view.parameters[chosen] && order('set', view.selected, view.parameters[chosen].key, null)],
    'u': ['undo', () => at('undo').click()],
    'd': ['phase portrait of a plane', () => {
        const portrait = view.parameters.find(({key}) => key === 'portrait');
        return portrait && order('set', view.selected, 'portrait', portrait.value === 'yes' ? 'no' : 'yes');
    }],
    't': ['dark or light', () => at('theme').click()],
    'e': ['a formula of your own', () => { at('words').focus(); at('words').select(); }],
    'p': ['save the picture', () => at('save').click()],
    'R': ['record a movie; again: end it', () => at('record').click()],
    'y': ['copy a link and the command line', () => at('copy').click()],
    'n': ['in a lesson: answer or next step', inTour(next)],
    'N': ['in a lesson: the step before', inTour(() => goTo(stepNumber - 1))],
    'a': ['in a lesson: this step again', inTour(() => goTo(stepNumber))],
    'H': ['in an exercise: a hint', inTour(() => say(lesson.steps[stepNumber].hint || 'This step has no hint.'))],
    'S': ['in an exercise: save your answer', inTour(() => at('grade').hidden || handIn())],
    '?': ['this page', () => at('help').click()],
};
for (let i = 0; i < most; i++) {
    keys[i + 1] = ['', () => i < view.lanes.length && select(i)];
}

document.addEventListener('keydown', event => {
    const inside = at('sheet').open || event.target.closest?.('input:not([type=range]), select');
    const onButton = event.target.closest?.('button') && (event.key === ' ' || event.key === 'Enter');
    const onSlider = event.target.matches?.('[type=range]') && /^(Arrow|Page|Home|End)/.test(event.key);
    if (event.key === 'Escape') {
        forking = false;
        document.activeElement.blur();
    }
    if (event.ctrlKey || event.metaKey || event.altKey || inside || onButton || onSlider || !view || !keys[event.key]) {
        return;
    }
    event.preventDefault();
    keys[event.key][1]();
});

const names = {' ': 'space', PageUp: 'PgUp', PageDown: 'PgDn', ArrowUp: '↑', ArrowDown: '↓', ArrowLeft: '←', ArrowRight: '→', Backspace: '⌫'};
at('help').onclick = () => sheet('Keys', make('table', null, ...Object.entries(keys).filter(([, [words]]) => words)
    .map(([key, [words]]) => make('tr', null, make('th', {scope: 'row'}, make('kbd', null, names[key] || key)), make('td', null, words))),
make('tr', null, make('th', {scope: 'row'}, make('kbd', null, '1 … 6')), make('td', null, 'choose a lane'))),
make('p', {className: 'soft'}, `geomint ${lesson.version}. The page holds the whole program: nothing is sent anywhere, and it works without a network.`));
at('close').onclick = () => at('sheet').close();
at('theme').onclick = () => { theme = !isDark(); shape(); };
at('revive').onclick = begin;
dark.onchange = shape;
new ResizeObserver(() => worker && shape()).observe(canvas);
at('title').textContent = document.title = lesson.title;
at('tour').hidden = !lesson.steps;
begin();
