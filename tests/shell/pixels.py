# SPDX-License-Identifier: GPL-3.0-or-later
"""What the explorer shows in terminals with pixels is the picture that `geomint render` paints.
Usage: pixels.py GEOMINT"""
import base64
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

import numpy

from terminal_emulator import Terminal, read_png

geomint = os.path.realpath(sys.argv[1])
folder = tempfile.TemporaryDirectory()
os.chdir(folder.name)
failures = 0

# without graphs, whose ranges grow while the explorer goes on
SCENE = ['disc', 'scheme=explicit-euler,midpoint', 'dt=pi/12', 'show=disc']


def check(good, sentence):
    global failures
    if not good:
        print('FAILED:', sentence, flush=True)
        failures += 1
    return good


def reference(steps, width, height, theme='dark'):
    out = f'reference-{steps}-{width}-{theme}'
    subprocess.run([geomint, 'render', *SCENE, f'steps={steps}', '--size', f'{width}x{height}', '--theme', theme,
                    '--out', out], check=True, stdout=subprocess.DEVNULL)
    return read_png(f'{out}/disc-render.png')


def compare(shown, png):
    """Greatest and mean difference of a channel, and how many pixels of the reference are not shown."""
    width, height, rows = png
    wanted = numpy.frombuffer(b''.join(rows), numpy.uint8).reshape(height, width, 3).astype(int)
    seen = [row[:width] for row in shown[:height]]
    is_shown = numpy.array([[pixel is not None for pixel in row] for row in seen])
    seen = numpy.array([[pixel or (0, 0, 0) for pixel in row] for row in seen])
    off = numpy.abs(seen - wanted)[is_shown]
    return off.max(initial=0), off.sum() / (3 * width * height), int((~is_shown).sum())


def paused_at(terminal, steps):
    """The state after so many steps from the start."""
    good = terminal.until(lambda: terminal.shows('SCHEMES') and terminal.picture()[30][30] is not None)
    check(good, 'no picture came')
    terminal.keys(' ')
    check(terminal.until(lambda: terminal.shows('paused')), 'it does not pause')
    terminal.keys('r')
    terminal.settle()
    terminal.keys('.' * steps)
    check(terminal.settle(), 'it does not come to rest')


def leave(terminal):
    terminal.keys('q')
    terminal.until(lambda: terminal.status is not None)
    check(terminal.status == 0, f'it ended with the status {terminal.status}')
    terminal.close()


def picture_of(kind, steps, columns, rows, cell, exact, **how):
    terminal = Terminal([geomint, *SCENE], columns=columns, rows=rows, cell=cell, kind=kind, **how)
    paused_at(terminal, steps)
    side = min(max(columns * 2 // 5, 31), 58)
    width, height = (columns - side) * cell[0], (rows - 3) * cell[1]
    if kind == 'sixel':
        height -= height % 6
    png = reference(steps, width, height)
    worst, mean, missing = compare(terminal.picture(), png)
    print(f'{kind} {width}x{height} {how}: greatest difference {worst}, mean {mean:.3f}, {missing} pixels missing, '
          f'{terminal.images} images')
    check(missing == 0, f'{kind}: parts of the picture are not shown')
    check(worst <= exact[0] and mean <= exact[1], f'{kind}: the picture is another one')
    # the comparison would see a picture that is one pixel off, or one of the step before
    other = compare([row[1:] + row[:1] for row in terminal.picture()], png)
    check(other[1] > exact[1] + 0.5, f'{kind}: a picture that is one pixel off is not told from it ({other})')
    other = compare(terminal.picture(), reference(steps - 1, width, height))
    check(other[1] > exact[1] + 0.5, f'{kind}: the picture of the step before is not told from it ({other})')
    return terminal


def ladder(terminal, *marks):
    """b goes through what the terminal has, and comes back to the picture."""
    for mark in marks:
        terminal.keys('b')
        check(terminal.until(lambda: mark(terminal)), f'b does not reach {mark.__name__}')


def braille(terminal):
    return not terminal.tiles and any(0x2800 < ord(c) < 0x2900 for row in terminal.text for c in row[:60])


def quadrants(terminal):
    return any(c in '▖▗▘▝▚▞' for row in terminal.text for c in row[:60])


def half_blocks(terminal):
    return not quadrants(terminal) and any(c in '▀▄' for row in terminal.text for c in row[:60])


def ascii_letters(terminal):
    return all(ord(c) < 127 for row in terminal.text for c in row)


def pixels(terminal):
    return terminal.picture()[30][30] is not None and not ascii_letters(terminal)


# Kitty: exact
kitty = picture_of('kitty', 5, 120, 36, (10, 20), (0, 0))
kitty.keys('?')
check(kitty.until(lambda: kitty.shows('KEYS') and not kitty.tiles), 'help is shown over the picture')
kitty.keys('?')
check(kitty.until(lambda: len(kitty.tiles) > 0), 'the picture does not come back')
before = kitty.picture()
ladder(kitty, braille, quadrants, half_blocks, ascii_letters, pixels)
check(kitty.until(lambda: kitty.picture() == before), 'all around the ladder the picture is another one')
tiles = kitty.images
kitty.resize(100, 30)
check(kitty.until(lambda: kitty.images > tiles and kitty.shows('paused')), 'no picture after a resize')
kitty.run(0.5)
check(all(x + w <= 600 and y + h <= 540 for x, y, w, h, _ in kitty.tiles.values()), 'a tile of the larger screen stays')
tiles, written = kitty.images, kitty.output
kitty.run(1)
check(kitty.output == written, 'paused, it writes')
leave(kitty)
check(not kitty.tiles, 'it leaves pictures behind')

# sixels: 256 colours in percents; cells of a height that bands of six rows do not fit
sixel = picture_of('sixel', 5, 120, 36, (9, 17), (64, 0.8))
sixel.keys('?')
check(sixel.until(lambda: sixel.shows('KEYS')), 'no help')
sixel.keys('?')
check(sixel.until(lambda: sixel.shows('SCHEMES') and sixel.picture()[30][30]), 'the picture does not come back')
sixel.settle()
check(compare(sixel.picture(), reference(5, 648, 558))[1] <= 0.9, 'after the help the picture is another one')
ladder(sixel, braille, quadrants, half_blocks, ascii_letters, pixels)
sixel.keys('.')
sixel.settle()
check(compare(sixel.picture(), reference(6, 648, 558))[1] <= 0.9, 'a step later the picture is another one')
leave(sixel)

# a terminal that takes no large picture at once, and alone knows the size of its cells
leave(picture_of('sixel', 3, 100, 30, (8, 16), (64, 0.8), sizes='terminal', limits=(400, 200)))
# a picture in the light theme
light = Terminal([geomint, *SCENE, '--theme', 'light'], columns=100, rows=30, kind='kitty', cell=(8, 16))
paused_at(light, 3)
check(compare(light.picture(), reference(3, 480, 432, 'light'))[0] == 0, 'in the light theme the picture is another one')
leave(light)

# nobody knows the size of a cell: blocks; unless pixels are demanded
unknown = Terminal([geomint, *SCENE], kind='sixel', sizes='nobody')
check(unknown.until(lambda: unknown.shows('SCHEMES')) and unknown.images == 0, 'pixels without a size')
leave(unknown)
forced = Terminal([geomint, *SCENE, '--graphics=sixel'], kind='sixel', sizes='nobody')
check(forced.until(lambda: forced.images > 0), '--graphics=sixel has no effect')
leave(forced)
plain = Terminal([geomint, *SCENE, '--graphics', 'half'], kind='kitty')
check(plain.until(lambda: half_blocks(plain)) and plain.images == 0, '--graphics=half has no effect')
leave(plain)
for how in ({'NO_COLOR': '1'}, {'TERM': 'tmux-256color'}, {'TERM': 'linux'}):
    other = Terminal([geomint, *SCENE], kind='kitty', environment=how)
    check(other.until(lambda: other.shows('SCHEMES')) and other.images == 0, f'pixels in spite of {how}')
    check('TERM' not in how or 'kitty' not in other.questions, f'{how}: the question would be shown or lost')
    leave(other)

# keys that are typed before the answers come are keys; answers that come late are not
early = Terminal([geomint, *SCENE], kind='sixel', delay=0.3, typed=b' \x1b[Bs')
check(early.until(lambda: early.shows('SWITCH TO') and early.shows('paused')), 'keys typed ahead are lost')
early.keys('\x1b')
check(early.until(lambda: early.shows('▸ system')), 'a cursor key typed ahead is lost')
leave(early)
late = Terminal([geomint, *SCENE], kind='sixel', delay=1.6)
check(late.until(lambda: late.shows('SCHEMES')), 'no screen without an answer')
check(late.images == 0, 'it has waited for the answer')
check(late.until(lambda: late.images > 0), 'a late answer leads to no pixels')
check(not late.shows('KEYS') and not late.shows('three') and late.shows('▸ dt'), 'a late answer is taken for keys')
leave(late)
for how in ({'typed': b'b'}, {'environment': {'GEOMINT_GRAPHICS': 'quadrants'}}):  # what the user chose stays
    late = Terminal([geomint, *SCENE], kind='sixel', delay=1.6, **how)
    check(late.until(lambda: late.shows('SCHEMES') and quadrants(late)), f'{how}: no quadrants')
    check(late.until(lambda: late.raised and not late.answers), f'{how}: its answer came to nothing')
    late.settle()
    check(late.images == 0, f'{how}: pixels in spite of what was chosen')
    leave(late)

# the documentation's terminal that begins with 16 colours is asked for more
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../docs/terminal.md'), encoding='utf-8') as page:
    line = re.search(r"`(xterm -ti vt340[^`]*)`", page.read())
check(line and 'decGraphicsID: vt340' in line[1], 'docs/terminal.md names no xterm with sixels')
few = Terminal([geomint, *SCENE], kind='sixel', registers=16)
check(few.until(lambda: few.images > 0), 'a terminal that begins with 16 colours shows no pixels')
check(few.registers == 256, f'it was asked for {few.registers} colours')
leave(few)

# y: the command line that redoes the view, also after changes in flight
told = Terminal([geomint, *SCENE], columns=100, rows=30, kind='kitty', cell=(8, 16))
paused_at(told, 3)
told.keys('\x1b[C' '..')  # another step: at once
told.settle()
told.keys('\t' 's' '\x1b[B' '\r')  # another scheme for the second lane, from here on
told.settle()
told.keys('..')
told.settle()
shown = told.picture()
told.keys('y')
check(told.until(lambda: told.shows('THIS VIEW')), 'y shows no command line')
copied = [text for text in told.questions if text.startswith('52;c;')]
if check(len(copied) == 1, 'y copies nothing'):
    command = base64.b64decode(copied[0][5:]).decode()
    check(command.startswith('geomint render disc ') and command[15:40] in ''.join(map(told.line, range(30))),
          f'y copies something else: {command}')
    check('--changes' in command, f'the changes are not in it: {command}')
    words = [geomint] + shlex.split(command)[1:] + ['--size', '480x432', '--out', 'told']
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    worst, mean, missing = compare(shown, read_png('told/disc-render.png'))
    print(f'redone by "{command}": greatest difference {worst}, {missing} pixels missing')
    check(worst == 0 and missing == 0, 'the command line makes another picture')
told.keys('y')  # the other one
check(told.until(lambda: len([text for text in told.questions if text.startswith('52;c;')]) == 2),
      'y copies the explorer\'s command line not')
copied = [text for text in told.questions if text.startswith('52;c;')]
check(base64.b64decode(copied[-1][5:]).startswith(b'geomint disc '), 'the second command line is no explorer')
told.keys('\x1b')
check(told.until(lambda: told.shows('SCHEMES')), 'the command line stays')

# R: a movie of what is seen, finished when it is ended, and on leaving
told.keys(' R')
check(told.until(lambda: told.shows('Recording disc-0001.mp4')), 'R does not begin a movie')
check(told.until(lambda: told.shows('● 0:02')), 'the status does not show the movie and its length')
told.keys('R')
check(told.until(lambda: told.shows('Saved disc-0001.mp4, a movie of ')), 'R does not end the movie')
said = re.search(r'a movie of ([0-9.]+) s', '\n'.join(told.line(row) for row in range(told.rows)))


def seconds_of(path):
    probe = subprocess.run(['ffprobe', '-v', 'error', '-show_entries', 'format=duration', '-of', 'csv=p=0', path],
                           capture_output=True, text=True)
    return float(probe.stdout or 0)


length, recorded = seconds_of('disc-0001.mp4'), float(said[1]) if said else 0
check(recorded >= 2 and abs(length - recorded - 1) < 0.1,
      f'the movie of {recorded} s, whose last frame stands for one, is {length} s long')
told.keys('R')
told.until(lambda: told.shows('● 0:01'))
os.kill(told.pid, signal.SIGTERM)
told.until(lambda: told.status is not None)
check(told.status is not None and os.WTERMSIG(told.status) == signal.SIGTERM, f'after SIGTERM its status is {told.status}')
check(seconds_of('disc-0002.mp4') > 1, 'the movie is lost with the signal')
check(sorted(f for f in os.listdir('.') if f.startswith('disc-0')) == ['disc-0001.mp4', 'disc-0002.mp4'],
      f'the movies leave files behind: {os.listdir(".")}')
told.close()

# a terminal at the end of a long line: frames are dropped and do not pile up
slow = Terminal([geomint, *SCENE], kind='sixel', delay=0.4)
slow.until(lambda: slow.images > 0)
before = len(slow.frames)
slow.run(4)
frames = len(slow.frames) - before
check(frames <= 22, f'{frames} frames in 4 s at .4 s a round trip')
check(slow.until(lambda: len(slow.frames) >= before + 3), 'at .4 s a round trip frames do not go on')
leave(slow)

# a slow line that takes all there is: little is on its way, so keys are answered
narrow = Terminal([geomint, 'disc', 'dt=0.02'], kind='plain', rate=4000)
check(narrow.until(lambda: narrow.shows('SCHEMES')), 'no screen at 4 kB/s')
narrow.run(10)
queued, begun = len(narrow.queue), time.monotonic()
narrow.keys(' ')
check(narrow.until(lambda: narrow.shows('paused')), 'it does not pause at 4 kB/s')
waited = time.monotonic() - begun
print(f'4 kB/s: {queued} bytes are on their way, a key is answered after {waited:.1f} s')
check(queued < 40000, f'at 4 kB/s {queued} bytes are on their way')
narrow.rate = None
leave(narrow)

# Ctrl-Z gives the shell a clean screen, and fg takes it back; where no shell could wake it, it passes
shell = Terminal(['/bin/bash', '--norc', '--noprofile', '-i'], kind='kitty')
shell.keys(f'{shlex.quote(geomint)} {" ".join(SCENE)}\n')
check(shell.until(lambda: shell.shows('SCHEMES') and shell.tiles), 'no screen in a shell')
for _ in range(2):
    shell.keys('\x1a')
    check(shell.until(lambda: shell.shows(SCENE[1])), 'Ctrl-Z does not stop it')  # the shell tells what it stopped
    check(not shell.tiles and not shell.shows('PARAMETERS'), 'stopped, it leaves its screen behind')
    shell.keys('fg\n')
    check(shell.until(lambda: shell.shows('SCHEMES') and shell.tiles), 'fg does not bring it back')
shell.keys('q')
check(shell.until(lambda: not shell.shows('SCHEMES') and not shell.tiles), 'it leaves its screen behind')
shell.keys('exit\n')
shell.until(lambda: shell.status is not None)
shell.close()
alone = Terminal([geomint, *SCENE], kind='plain')
check(alone.until(lambda: alone.shows('SCHEMES')), 'no screen')
alone.keys('\x1a')
alone.run(1)
leave(alone)

# what the terminal answers about its colours; the environment counts more
for answers, how, colours in (({'background': 'ffff/ffff/dddd'}, {'COLORTERM': ''}, ['256', 'light']),
                              ({'background': '1e/1e/22', 'true_colour': True}, {'COLORTERM': ''},
                               ['truecolor', 'dark']),
                              ({'background': 'ffff/ffff/dddd'}, {'COLORFGBG': '15;0'}, ['truecolor', 'dark']),
                              ({'background': 'fff/fff/ddd'}, {'COLORFGBG': 'default;default'}, ['truecolor', 'light']),
                              ({'background': 'white'}, {}, ['truecolor', 'dark'])):
    asked = Terminal([geomint, 'terminal'], kind='plain', environment=how, **answers)
    asked.until(lambda: asked.status is not None)
    for line in range(asked.rows):
        words = asked.line(line).split()
        if words[:1] == ['colours']:
            check(words[1] == colours[0], f'{answers}, {how}: {words}')
        if words[:1] == ['theme']:
            check(words[1] == colours[1], f'{answers}, {how}: {words}')
            colours = None
            break
    check(colours is None, f'{answers}, {how}: no theme is told')
    asked.close()

print('pixels:', 'all passed' if not failures else f'{failures} failures')
sys.exit(failures > 0)
