# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames a second of the explorer, bytes a frame, and the processor time of all that takes part, at 160x45.
Usage: explorer_frames.py GEOMINT [tmux|plain] [SECONDS] [SCENE key=value ... [,, SCENE ...]]

In tmux the explorer runs in a pane of a server of its own, to which a client is attached that this program reads;
plain, this program is the terminal: it reads all and answers that it has read it."""
import fcntl
import os
import pty
import re
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time

COLUMNS, ROWS = 160, 45
END = b'\x1b[?2026l'  # of a frame
TICKS = os.sysconf('SC_CLK_TCK')
FOUR = 'explicit-euler,implicit-euler,symplectic-euler,midpoint'
SIX = 'explicit-euler,implicit-euler,midpoint,rk2,rk4,gauss4'
STANDARD = [['disc', f'scheme={FOUR}', 'dt=0.02']] + [
    [scene, f'scheme={schemes}', 'dt=0.02'] for scene in ('disc', 'kepler', 'vortices') for schemes in ('rk4', SIX)] + [
    ['sine-gordon', 'scheme=leapfrog'],
    ['sine-gordon', 'scheme=leapfrog', 'dt=0.02,0.019,0.018,0.017,0.016,0.015'],
    ['room'], ['room', 'dt=0.002,0.0019,0.0018,0.0017,0.0016,0.0015']]


def open_terminal(command, environment):
    pid, master = pty.fork()
    if pid == 0:
        os.read(0, 1)  # until the size is set
        os.execvpe(command[0], command, environment)
    fcntl.ioctl(master, termios.TIOCSWINSZ, struct.pack('HHHH', ROWS, COLUMNS, 0, 0))
    os.write(master, b'\n')
    return pid, master


def serve(master, seconds):
    """Reads and answers for so long; returns how many bytes and ends of frames it read."""
    end, size, frames, last = time.monotonic() + seconds, 0, 0, b''
    while (left := end - time.monotonic()) > 0:
        if not select.select([master], [], [], left)[0]:
            break
        try:
            data = os.read(master, 1 << 16)
        except OSError:
            break
        size += len(data)
        frames += (last + data).count(END)
        last = data[1 - len(END):]
        for question in re.findall(rb'\x1b\[(?:5n|c)', data):
            os.write(master, b'\x1b[0n' if question.endswith(b'n') else b'\x1b[?62;22c')
    return size, frames


def processor(pid):
    """Seconds that all threads of a process took so far."""
    fields = open(f'/proc/{pid}/stat').read().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def resident(pid):
    return int(re.search(r'VmRSS:\s*(\d+)', open(f'/proc/{pid}/status').read())[1]) / 1024


def measure(geomint, words, through, seconds):
    environment = dict(os.environ, TERM='xterm-256color', COLORTERM='truecolor', LC_ALL='C.UTF-8')
    for name in ('TMUX', 'NO_COLOR', 'GEOMINT_COLOURS', 'GEOMINT_GRAPHICS', 'GEOMINT_THEME'):
        environment.pop(name, None)
    folder = tempfile.mkdtemp()
    tmux = ['tmux', '-f', '/dev/null', '-S', f'{folder}/socket']
    try:
        if through == 'tmux':
            shell = ['env', 'COLORTERM=truecolor', geomint, 'tui'] + words
            subprocess.run(tmux + ['new-session', '-d', '-x', str(COLUMNS), '-y', str(ROWS)] + shell, check=True,
                           env=environment)
            subprocess.run(tmux + ['set-option', '-g', 'status', 'off', ';', 'set-option', '-ga', 'terminal-overrides',
                                   ',*:Tc'], check=True, env=environment)
            client, master = open_terminal(tmux + ['attach'], environment)
            time.sleep(0.2)
            ask = lambda what: int(subprocess.run(tmux + ['display', '-p', what], capture_output=True, text=True,
                                                  check=True).stdout)
            explorer, others = ask('#{pane_pid}'), [ask('#{pid}'), client]
        else:
            explorer, master = open_terminal([geomint, 'tui'] + words, environment)
            others = []
        serve(master, 4)  # until it is at its pace
        copy = f'{folder}/copy'
        if through == 'tmux':
            subprocess.run(tmux + ['pipe-pane', f'cat >{copy}'], check=True, env=environment)
        begun = time.monotonic()
        before = processor(explorer), [processor(pid) for pid in others]
        received, frames = serve(master, seconds)
        now = processor(explorer), [processor(pid) for pid in others]
        passed = time.monotonic() - begun
        size = received
        if through == 'tmux':
            with open(copy, 'rb') as stream:
                data = stream.read()
            size, frames = len(data), data.count(END)
        own, rest = (now[0] - before[0]) / passed, sum(b - a for a, b in zip(before[1], now[1])) / passed
        print(f'{" ".join(words)[:70]:70} {frames / passed:5.1f} frames/s {size / max(frames, 1) / 1000:5.1f} kB/frame '
              f'{size / passed / 1000:4.0f} kB/s  geomint {100 * own:3.0f} % {through} {100 * rest:3.0f} % '
              f'{resident(explorer):4.0f} MB', flush=True)
        os.write(master, b'q')
        serve(master, 1)
        os.close(master)
    finally:
        if through == 'tmux':
            subprocess.run(tmux + ['kill-server'], stderr=subprocess.DEVNULL)
        shutil.rmtree(folder)


def main():
    geomint, words = os.path.realpath(sys.argv[1]), sys.argv[2:]
    through = words.pop(0) if words and words[0] in ('tmux', 'plain') else 'tmux'
    seconds = float(words.pop(0)) if words and words[0].replace('.', '').isdigit() else 10
    scenes = [run.split() for run in ' '.join(words).split(',, ')] if words else STANDARD
    for scene in scenes:
        measure(geomint, scene, through, seconds)


main()
