# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys, mouse events, broken sequences and new sizes at random: the explorer never crashes, hangs or leaves the
terminal other than it was. Usage: fuzz_keys.py GEOMINT [SECONDS [SEED [SCENE ...]]]"""
import fcntl
import os
import pty
import random
import re
import select
import shutil
import signal
import struct
import sys
import tempfile
import termios
import time

geomint = os.path.realpath(sys.argv[1])
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 20
seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
SCENES = sys.argv[4:] or ['disc', 'kepler', 'vortices', 'sine-gordon', 'henon-heiles', 'oscillator', 'abc', '']

PATIENCE = 40  # seconds, for a sanitizer on a busy machine
ALARM = 2  # seconds after a signal in which the explorer has to notice it; then the signal ends it at once
KINDS = {'plain': b'\x1b[?62;22c', 'sixel': b'\x1b[?62;4;22c', 'kitty': b'\x1b[?62;22c'}
SIZES = [(80, 24), (160, 45), (100, 30), (40, 10), (61, 12), (20, 5), (9, 3), (1, 1), (2, 2), (300, 90), (5, 60)]
CURSOR = [b'\x1b[A', b'\x1b[B', b'\x1bOC', b'\x1bOD', b'\x1b[H', b'\x1b[F', b'\x1b[5~', b'\x1b[6~', b'\x1b[3~']
# every key that does something, those that begin a study or a movie less often
COMMON = list(b' .,[]sfcxoivt=\t\r\x1b?lbrB>y/0123456789e-*piGan\x7f\x0c')
RARE = [b'w', b'm', b'R', b'p', b'\x1a', b'\x1b', b'\x00', b'\xc3', b'\xff\xfe', b'\xe2\x96', b'\x1b[', b'\x1b[<',
        b'\x1b]11;', b'\x1bP1$r', b'\x1b_G', b'\x1b[<0;99999999999;1M', b'\x1b[<0;-1;0M',
        b'\x1b[?1;2;3;4;5;6;7;8;9;1;1;1;1;1;1;1;1c', b'\x1b]11;rgb:zz/1/2\x07', b'\x1b[200~', b'\x1b[0n' * 70,
        b'\x1b[6;0;0t', b'\x1b[6;999999999;7t', b'9' * 300]


class Session:
    """One run of the explorer in a pty."""

    def __init__(self, choose):
        self.kind = choose.choices(list(KINDS), [8, 1, 1])[0]
        self.size = choose.choice(SIZES)
        scene = choose.choice(SCENES)
        command = [geomint, 'tui'] + ([scene] if scene else [])
        colours = choose.choice(['truecolor', '256', '16', 'none'] if self.kind == 'plain' else ['truecolor'])
        self.what = f'{" ".join(command[1:])}, {self.kind}, {colours}'
        self.command = command + ['--colours', colours]
        self.modes, self.pending, self.read = {}, b'', 0
        environ = dict(os.environ, TERM='xterm-256color', LC_ALL='C.UTF-8')
        for name in ('TMUX', 'NO_COLOR', 'COLORTERM', 'GEOMINT_COLOURS', 'GEOMINT_GRAPHICS', 'GEOMINT_THEME'):
            environ.pop(name, None)
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            os.read(0, 1)
            os.execve(self.command[0], self.command, environ)
        self.status = None
        self.before = termios.tcgetattr(self.master)
        self.resize(*self.size)
        os.write(self.master, b'\n')

    def resize(self, columns, rows):
        self.size = columns, rows
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack('HHHH', rows, columns, columns * 8, rows * 16))

    def take(self, data):
        self.read += len(data)
        data = self.pending + data
        for token in re.finditer(rb'\x1b\[\?(\d+)([hl])|\x1b\[(5n|c|16t|14t)|(\x1b_G[^;]*a=q)|\x1b\[\?[\d;]*S', data):
            if token[1]:
                self.modes[token[1].decode()] = token[2] == b'h'
            elif token[3]:
                self.write({b'5n': b'\x1b[0n', b'c': KINDS[self.kind]}.get(token[3], b''))
            elif token[4] and self.kind == 'kitty':
                self.write(b'\x1b_Gi=31;OK\x1b\\')
        self.pending = data[max(data.rfind(b'\x1b'), 0):] if b'\x1b' in data[-64:] else b''
        self.pending = b'' if re.match(rb'\x1b\[[?\d;]*[a-zA-Z]', self.pending) else self.pending

    def write(self, data):
        try:
            os.write(self.master, data)
        except OSError:
            pass  # it has ended

    def run(self, duration, until=None):
        """Reads for so long, or until the condition holds; True if it does, or if there is none."""
        end = time.monotonic() + duration
        while self.status is None and not (until and until()):
            left = end - time.monotonic()
            if left <= 0:
                return until is None
            if select.select([self.master], [], [], min(left, 0.1))[0]:
                try:
                    self.take(os.read(self.master, 1 << 16))
                except OSError:
                    pass
            ended, status = os.waitpid(self.pid, os.WNOHANG)
            if ended:
                self.status = status
                self.run_out()
        return True

    def run_out(self):
        """Reads what is left. The last bytes of a program that has ended may still be on their way from the kernel, which
        says the end before: they are waited for while a mode is on that its leaving turns off."""
        end = time.monotonic() + 5
        while select.select([self.master], [], [], 1)[0]:
            try:
                self.take(os.read(self.master, 1 << 16))
            except OSError:
                if not self.modes_on() or time.monotonic() > end:
                    break
                time.sleep(0.05)

    def modes_on(self):
        return [mode for mode, value in self.modes.items() if value and mode not in ('25', '7')]


def event(choose, session):
    """Bytes to type, or None after a change of size."""
    kind = choose.random()
    columns, rows = session.size
    if kind < 0.55:
        return bytes([choose.choice(COMMON)])
    if kind < 0.7:
        return choose.choice(CURSOR)
    if kind < 0.86:
        button = choose.choice([0, 0, 0, 1, 2, 32, 32, 64, 65, 3, 35, 128])
        place = choose.randint(0, columns + 2), choose.randint(0, rows + 2)
        return f'\x1b[<{button};{place[0]};{place[1]}{choose.choice("MMm")}'.encode()
    if kind < 0.94:
        return choose.choice(RARE)
    session.resize(*(choose.choice(SIZES) if choose.random() < 0.7 else
                     (choose.randint(1, 250), choose.randint(1, 80))))
    return None


def fail(session, sentence, sent):
    print(f'FAILED: {sentence} ({session.what}, seed {seed}, {session.size[0]}x{session.size[1]})\n'
          f'  the last it was sent: {sent[-40:]}', flush=True)
    try:
        os.kill(session.pid, signal.SIGABRT)
        os.kill(session.pid, signal.SIGKILL)
    except OSError:
        pass
    sys.exit(1)


def clicked(sent):
    """Whether it may have been left by a click on what stands for key q, the one of these events that does that."""
    return any(isinstance(typed, bytes) and re.search(rb'<0;.*M', typed) for typed in sent)


def leave(choose, session, sent):
    """One of the ways out; the terminal is as it was then."""
    way = choose.choice(['q', 'q', 'SIGTERM', 'SIGINT', 'SIGHUP', 'hangup'])
    begun = time.monotonic()
    if way == 'hangup':
        os.close(session.master)
        end = time.monotonic() + PATIENCE
        while not os.waitpid(session.pid, os.WNOHANG)[0]:
            if time.monotonic() > end:
                fail(session, 'it outlives its terminal', sent)
            time.sleep(0.05)
        return
    if way == 'q':
        session.resize(80, 24)
        end = time.monotonic() + PATIENCE
        while session.status is None and time.monotonic() < end:  # out of a prompt or a list, then off
            session.write(b'\x1b')
            session.run(0.3)
            session.write(b'\x1b')
            session.run(0.3)
            session.write(b'qq')  # a loss is asked for first
            session.run(0.5)
        wanted = {0}
    else:
        os.kill(session.pid, getattr(signal, way))
        wanted = {130 << 8} if way == 'SIGINT' else {int(getattr(signal, way))}
        wanted |= {0} if clicked(sent) else set()  # events that wait may have come first
    if not session.run(PATIENCE, lambda: session.status is not None) or session.status is None:
        fail(session, f'{way} does not end it', sent)
    if way == 'SIGINT' and time.monotonic() - begun >= ALARM:  # a sanitizer on a busy machine is late at times
        wanted.add(int(signal.SIGINT))
    if session.status not in wanted:
        fail(session, f'after {way} its status is {session.status:#x}', sent)
    if session.modes_on() or not session.modes.get('25', True):
        fail(session, f'it leaves the terminal with the modes {session.modes}', sent)
    if termios.tcgetattr(session.master)[:4] != session.before[:4]:
        fail(session, 'it leaves the terminal with other settings', sent)
    os.close(session.master)


def main():
    choose = random.Random(seed)
    folder = tempfile.mkdtemp()
    os.chdir(folder)
    end, events, sessions = time.monotonic() + seconds, 0, 0
    while time.monotonic() < end:
        session, sent = Session(choose), []
        sessions += 1
        session.run(1.5, lambda: session.read > 2000)
        for _ in range(choose.randint(20, 400)):
            typed = event(choose, session)
            sent.append(typed if typed else session.size)
            if typed:
                session.write(typed)
            events += 1
            session.run(choose.choice([0, 0, 0, 0.005, 0.02, 0.1]))
            if session.status is not None or time.monotonic() > end:
                break
        if session.status is None:
            # a new size makes it draw all, unless there is no picture yet: then at least it can be left
            read = session.read
            session.resize(90, 25 if session.size != (90, 25) else 26)
            session.run(PATIENCE / 4, lambda: session.read > read)
            leave(choose, session, sent)
        elif session.status != 0 or not clicked(sent):
            fail(session, f'it ends by itself with the status {session.status:#x}', sent)
        else:
            os.close(session.master)
    shutil.rmtree(folder)
    print(f'fuzz keys: {events} events in {sessions} sessions')


main()
