# SPDX-License-Identifier: GPL-3.0-or-later
"""Every signal that ends a process ends the explorer, whenever it comes, and the terminal is as it was then: its
settings, its modes, its cursor. Usage: signals.py GEOMINT"""
import ctypes
import fcntl
import os
import pty
import re
import resource
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import zlib

geomint = os.path.realpath(sys.argv[1])
libc = ctypes.CDLL(None)

PATIENCE = 60  # seconds, for a sanitizer on a busy machine
AT_ONCE = 10  # sessions
POLITE = ['SIGINT', 'SIGTERM', 'SIGQUIT', 'SIGHUP', 'SIGUSR1', 'SIGUSR2', 'SIGALRM', 'SIGVTALRM', 'SIGPROF', 'SIGXCPU',
          'SIGIO', 'SIGPWR', 'SIGSTKFLT', 'SIGRTMIN', 'SIGRTMAX']
FAULTS = ['SIGSEGV', 'SIGABRT', 'SIGBUS', 'SIGFPE', 'SIGILL', 'SIGTRAP', 'SIGSYS']
FEW = ['SIGTERM', 'SIGHUP', 'SIGUSR1', 'SIGALRM', 'SIGXCPU', 'SIGSEGV']
LONG = ['run disc until=1e8 dt=1e-3', 'run disc until=1e12 dt=1e-3 --yes', 'run disc points=1e6 until=1e6',
        "run system H=p^2/2+sum(i=1..1000,cos(q*i)/i^3) q=1 p=0 until=1e6", 'render disc until=1e8 dt=1e-3 --yes',
        'render kepler until=1e9 --frames 9', 'work-precision kepler until=1e7', 'stability kepler until=1e6',
        'backward disc until=1e12 dt=1e-3 --yes', 'backward disc until=1e8 dt=1e-3',
        'sweep kepler eccentricity=0..0.9:1000 until=1e7 --yes', 'certify all', 'figures --out made']
SHORT = ['list', 'cache', 'manual', 'complete run ke', '--version']
NUMBERS = {name: int(getattr(signal, name, 16)) for name in POLITE + FAULTS}  # 16: SIGSTKFLT, which Python lacks


class Session:
    """A program in a pty that answers as the terminal that it is: none, plain or kitty."""

    def __init__(self, what, command, answers='none', discards=True):
        self.what, self.answers = what, answers
        self.folder = tempfile.mkdtemp()
        self.seen, self.pending, self.modes, self.keypad = b'', b'', {}, False
        self.status, self.error, self.reads = None, None, True
        environ = dict(os.environ, TERM='xterm-256color', LC_ALL='C.UTF-8', PS1='ready> ')
        for name in ('TMUX', 'NO_COLOR', 'COLORTERM', 'GEOMINT_COLOURS', 'GEOMINT_GRAPHICS', 'GEOMINT_THEME'):
            environ.pop(name, None)
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            try:
                os.read(0, 1)  # until the size is set
                os.chdir(self.folder)
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
                resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 1))
                for number in NUMBERS.values():
                    signal.signal(number, signal.SIG_DFL)
                os.execve(command[0], command, environ)
            finally:
                os._exit(127)  # the folders belong to the parent
        self.before = termios.tcgetattr(self.master)
        if not discards:
            self.before[3] |= termios.NOFLSH
            termios.tcsetattr(self.master, termios.TCSANOW, self.before)
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack('HHHH', 30, 100, 1000, 600))
        os.write(self.master, b'\n')

    def keys(self, text):
        os.write(self.master, text if isinstance(text, bytes) else text.encode())

    def shows(self, text):
        return lambda: text.encode() in self.seen

    def send(self, name, times=1):
        for _ in range(times):
            if self.status is None:
                os.kill(self.pid, NUMBERS[name])

    def take(self, data):
        self.seen += data
        data = self.pending + data
        at = 0
        for token in re.finditer(rb'\x1b\[\?([\d;]+)([hl])|\x1b\[(5n|c)|(\x1b_G[^;\x1b]*a=q)|\x1b([=>])', data):
            at = token.end()
            if token[1]:
                for mode in token[1].split(b';'):
                    self.modes[int(mode)] = token[2] == b'h'
            elif token[5]:
                self.keypad = token[5] == b'='
            elif self.answers != 'none' and token[3]:
                self.keys({b'5n': b'\x1b[0n', b'c': b'\x1b[?62;22c'}[token[3]])
            elif self.answers == 'kitty' and token[4]:
                self.keys(b'\x1b_Gi=31;OK\x1b\\')
        self.pending = data[max(at, len(data) - 32):]

    def look(self):
        """Reads what there is."""
        while self.reads and select.select([self.master], [], [], 0)[0]:
            try:
                data = os.read(self.master, 1 << 16)
            except OSError:
                break
            if not data:
                break
            self.take(data)
        if self.status is None:
            ended, status, used = os.wait4(self.pid, os.WNOHANG)
            if ended:
                self.status, self.used = status, used.ru_utime + used.ru_stime
                if self.reads:
                    self.look()

    def ended(self):
        return self.status is not None

    def given_back(self):
        """None if the terminal is as it was, or a sentence."""
        on = sorted(mode for mode, value in self.modes.items() if value and mode not in (7, 25))
        if on or not self.modes.get(25, True) or self.keypad:
            return f'it leaves the terminal with the modes {self.modes}, keypad {self.keypad}'
        if termios.tcgetattr(self.master) != self.before:
            return 'it leaves the terminal with other settings'
        return None

    def close(self):
        if self.status is None:
            os.kill(self.pid, signal.SIGKILL)
            os.waitpid(self.pid, 0)
        os.close(self.master)
        shutil.rmtree(self.folder)


# Plays are generators: each yields what it waits for.

def passed(seconds):
    end = time.monotonic() + seconds
    return lambda: time.monotonic() >= end


def ends(session, name, restored=True):
    yield session.ended
    wanted = NUMBERS[name]
    interrupted = name == 'SIGINT' and session.status == 130 << 8
    if os.WTERMSIG(session.status) != wanted and not interrupted and name not in FAULTS:
        session.error = f'its status is {session.status:#x}'
    if restored:
        session.error = session.error or session.given_back()


def asked(name, moment):
    """The terminal never answers: the signal comes so many seconds after it was asked."""
    session = Session(f'{name} {moment} s after a question', [geomint, 'disc'])
    yield session
    yield session.shows('\x1b[c')
    yield passed(moment)
    session.send(name)
    yield from ends(session, name)


def asked_by_report(name):
    session = Session(f'{name} in geomint terminal', [geomint, 'terminal'])
    yield session
    yield session.shows('\x1b[c')
    session.send(name)
    yield from ends(session, name)


def opened(what, command, answers='plain', discards=True):
    session = Session(what, command, answers, discards)
    yield session
    yield session.shows('SCHEMES')
    return session


def running(name):
    session = yield from opened(f'{name} while it runs', [geomint, 'disc'])
    session.send(name)
    yield from ends(session, name)


def dragging(name):
    session = yield from opened(f'{name} while the mouse drags', [geomint, 'disc'])
    for text in ('\x1b[<0;30;10M', '\x1b[<32;32;11M', '\x1b[<32;34;12M\x1b[<32;3'):
        session.keys(text)
    session.send(name)
    yield from ends(session, name)


def recording(name):
    session = yield from opened(f'{name} while it records', [geomint, 'disc'])
    session.keys('R')
    while '● 0:01'.encode() not in session.seen:  # a recording without a frame leaves no movie
        session.keys('\x0c')  # drawn anew: else the digit alone is
        yield passed(0.1)
    session.send(name)
    yield from ends(session, name)
    if name in POLITE and not os.path.getsize(os.path.join(session.folder, 'disc-0001.mp4')):
        session.error = session.error or 'the movie is lost'


def studying(name, key):
    session = yield from opened(f'{name} while a study runs', [geomint, 'kepler'])
    session.keys(key)
    yield session.shows('%')
    session.send(name)
    yield from ends(session, name)


def painting(name, moment):
    session = yield from opened(f'{name} while it paints, {moment} s', [geomint, 'kepler'], 'kitty')
    yield session.shows('\x1b_Ga=T')
    yield passed(moment)
    session.send(name)
    yield from ends(session, name)


def own_threads(session):
    """All but the first, and but those that belong to the library that paints."""
    def name(thread):
        with open(f'/proc/{session.pid}/task/{thread}/comm', encoding='ascii') as comm:
            return comm.read()
    threads = [thread for thread in map(int, os.listdir(f'/proc/{session.pid}/task'))
               if thread != session.pid and name(thread) == name(session.pid)]
    return sorted(threads)


def faulting(number):
    """A fault in one of its threads."""
    session = yield from opened(f'a fault in thread {number}', [geomint, 'kepler'], 'kitty')
    yield session.shows('\x1b_Ga=T')
    yield lambda: len(own_threads(session)) > number
    libc.tgkill(session.pid, own_threads(session)[number], int(signal.SIGSEGV))
    yield from ends(session, 'SIGSEGV')


def taken(session):
    """Of a processor, in seconds: a busy machine has nothing to do with it."""
    try:
        with open(f'/proc/{session.pid}/stat', encoding='ascii') as stat:
            return sum(map(int, stat.read().rpartition(')')[2].split()[11:15])) / os.sysconf('SC_CLK_TCK')
    except (FileNotFoundError, ProcessLookupError):
        return 0


def signals_of(session, key):
    """A set of signals, as bits: those that have a handler, or those that wait for the process."""
    try:
        with open(f'/proc/{session.pid}/status', encoding='ascii') as status:
            return next(int(line.split()[1], 16) for line in status if line.startswith(f'{key}:'))
    except (FileNotFoundError, ProcessLookupError):
        return 0


def opens_for_long(what):
    """A run whose files are open, and whose lane takes long to open, which does not look at signals."""
    session = Session(what, [geomint, 'run', 'taylor-green', 'columns=512', 'until=100', '--csv', 'rows.csv'])
    yield session
    yield lambda: session.ended() or os.path.exists(os.path.join(session.folder, 'rows.csv'))
    return session


def cut_off(session, most):
    """Ends within so many seconds of a processor."""
    before = taken(session)
    yield session.ended
    if session.status != 130 << 8:
        session.error = f'its status is {session.status:#x}'
    elif session.used - before > most:
        session.error = f'it goes on for {session.used - before:.1f} s'
    elif left := [file for file in os.listdir(session.folder) if '.tmp' in file]:
        session.error = f'it leaves {left}'


def interrupted_once(name):
    session = yield from opens_for_long(f'{name} while a lane opens')
    session.send(name)
    yield from cut_off(session, 3)


def insisted():
    session = yield from opens_for_long('two signals while a lane opens')
    session.send('SIGTERM')
    yield lambda: session.ended() or not signals_of(session, 'ShdPnd') >> NUMBERS['SIGTERM'] - 1 & 1
    yield passed(0.3)  # since it was received: on a busy machine that may be late, and signals within 0.2 s count as one
    session.send('SIGINT')
    yield from cut_off(session, 1)


def hears(session, name):
    """Whether it has a handler of its own for a signal: where starting takes long, it has none yet, and ends at once."""
    return bool(signals_of(session, 'SigCgt') >> NUMBERS[name] - 1 & 1)


def interrupted(name, words, under_way=0.5, most=2):
    """A command that would go on for long, and has begun to: it ends within so many seconds of a processor."""
    session = Session(f'{name} in geomint {words}', [geomint, *words.split()])
    yield session
    yield lambda: session.ended() or taken(session) >= under_way and hears(session, name)
    if session.ended():
        session.error = f'it ends by itself: {session.seen[-200:]}'
        return
    session.send(name)
    yield from cut_off(session, most)


def long_picture(folder):
    """A picture that tells of more steps than it was made with: to make it again takes long."""
    path = os.path.join(folder, 'long.png')
    subprocess.run([geomint, 'render', 'kepler', 'steps=50', '--size', '64x64', '-o', path], check=True,
                   stderr=subprocess.DEVNULL)
    with open(path, 'rb') as file:
        whole = file.read()
    at, changed = 8, whole[:8]
    while at < len(whole):
        size, kind = struct.unpack('>I4s', whole[at:at + 8])
        body = whole[at + 8:at + 8 + size]
        if body.startswith((b'geomint:arguments', b'geomint:steps')):
            body = re.sub(rb'\b50\b', b'20000000000', body)
        changed += struct.pack('>I4s', len(body), kind) + body + struct.pack('>I', zlib.crc32(kind + body))
        at += 12 + size
    with open(path, 'wb') as file:
        file.write(changed)
    return path


def short(words):
    """A command that hardly takes any time."""
    session = Session(f'SIGINT in geomint {words}', [geomint, *words.split()])
    yield session
    session.send('SIGINT')
    yield session.ended
    if session.status not in (0, 130 << 8, NUMBERS['SIGINT']) or session.used > 2:
        session.error = f'its status is {session.status:#x} after {session.used} s'


def deaf():
    """A terminal that takes nothing: who insists is heard."""
    session = yield from opened('SIGTERM while the terminal takes nothing', [geomint, 'disc'])
    session.reads = False
    full = struct.unpack('i', fcntl.ioctl(session.master, termios.FIONREAD, b'\0\0\0\0'))[0]
    while True:  # until the line is full
        yield passed(0.5)
        before, full = full, struct.unpack('i', fcntl.ioctl(session.master, termios.FIONREAD, b'\0\0\0\0'))[0]
        if full == before:
            break
    while not session.ended():
        session.send('SIGTERM')
        yield passed(0.05)
    yield from ends(session, 'SIGTERM', restored=False)
    if termios.tcgetattr(session.master) != session.before:
        session.error = session.error or 'it leaves the terminal with other settings'


def never_stopped(pause, discards):
    """Ctrl-Z again and again in a terminal whose shell could not wake it, which the system lets pass. With ordinary
    settings the terminal discards at each Ctrl-Z what has been typed, which is no end of the terminal, and what has been
    written and not yet read. This may be all that gives the terminal back, so its modes are known with NOFLSH alone."""
    session = yield from opened(f'Ctrl-Z many times, {pause} s apart, discarded: {discards}', [geomint, 'disc'],
                                discards=discards)
    for _ in range(40):
        session.keys(b'x\x1a\x1a')
        yield passed(pause)
    session.send('SIGTERM')
    yield from ends(session, 'SIGTERM', restored=not discards)


def ended_by(process):
    """The signal that ended a process, 0 if its parent has asked after it, None if it has not ended."""
    try:
        with open(f'/proc/{process}/stat', encoding='ascii') as stat:
            fields = stat.read().rpartition(')')[2].split()
            return int(fields[-1]) & 0x7f if fields[0] == 'Z' else None
    except (FileNotFoundError, ProcessLookupError):
        return 0


def stopped():
    """It is stopped, and ended by the shell, which has the terminal."""
    session = Session('Ctrl-Z and kill', ['/bin/bash', '--norc', '--noprofile', '-i'], 'plain')
    yield session
    yield session.shows('ready> ')
    session.keys(f'"{geomint}" disc\n')
    yield session.shows('SCHEMES')
    session.seen = b''
    session.keys(b'\x1a')
    yield session.shows('ready> ')
    with open(f'/proc/{session.pid}/task/{session.pid}/children', encoding='ascii') as children:
        child = children.read().split()[0]
    session.keys('kill %1\n')
    numbers = []
    yield lambda: [numbers.append(number) for number in [ended_by(child)] if number is not None]
    session.keys('echo $((6 * 7)) and on\n')
    yield session.shows('42 and on')
    if numbers[0] == 0:
        yield session.shows('Terminated')
    elif numbers[0] != signal.SIGTERM: # on a busy machine a shell may not hear at once that it has ended
        session.error = f'it was ended by signal {numbers[0]}'
    on = [mode for mode in (1, 1000, 1002, 1003, 1006, 1049) if session.modes.get(mode)]
    if on or not session.modes.get(25, True):
        session.error = f'it leaves the terminal with the modes {session.modes}'
    session.keys('exit\nexit\n') # the first may be answered that a job is stopped
    yield session.ended


def plays(folder):
    for name in POLITE + FAULTS:
        for moment in (0, 0.4, 0.7):
            yield asked(name, moment)
        yield asked_by_report(name)
        yield running(name)
    for name in FEW:
        for moment in (0.95, 1, 1.01, 1.02, 1.05):  # when it takes the terminal over
            yield asked(name, moment)
        yield dragging(name)
        yield studying(name, 'w')
        yield studying(name, 'm')
        for moment in (0, 0.05, 0.3):
            yield painting(name, moment)
        if shutil.which('ffmpeg'):
            yield recording(name)
    for name in 'SIGINT', 'SIGTERM':
        for words in LONG:
            yield interrupted(name, words)
        # while its formulas are read, before it has opened anything
        yield interrupted(name, 'run system H=p^2/2+sum(i=1..10000,cos(q*i)/i^3) q=1 p=0 until=1e6', 0.2)
        yield interrupted(name, 'render disc --size 12000x12000', 1)
        yield interrupted_once(name)
        yield interrupted(name, 'again ' + long_picture(folder))
        if shutil.which('ffmpeg'):
            yield interrupted(name, 'tour area --movie area.mp4', most=20)  # with all that ffmpeg took
    for words in SHORT:
        yield short(words)
    yield faulting(0)
    yield faulting(1)
    yield deaf()
    yield insisted()
    for pause in (0, 0.001, 0.003, 0.01, 0.03):
        yield never_stopped(pause, True)
        yield never_stopped(pause, False)
    yield stopped()


class Playing:
    def __init__(self, play):
        self.play, self.session = play, next(play)
        self.until, self.since = None, time.monotonic()

    def go_on(self):
        """False when it is over."""
        self.session.look()
        try:
            while self.until is None or self.until():
                self.until, self.since = next(self.play), time.monotonic()
        except StopIteration:
            return False
        except OSError as error:
            self.session.error = self.session.error or str(error)
            return False
        if time.monotonic() - self.since > PATIENCE:
            self.session.error = f'it waits in vain; the last it wrote: {self.session.seen[-200:]}'
            return False
        return True


def main():
    # A child that is interrupted before it becomes geomint ends at once. Python's own handler would go on to clean up,
    # and remove the folder of pictures that other sessions read.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    pictures = tempfile.TemporaryDirectory()
    waiting, now, count, failures = list(plays(pictures.name)), [], 0, 0
    waiting.reverse()
    while waiting or now:
        while waiting and len(now) < AT_ONCE:
            now.append(Playing(waiting.pop()))
        select.select([one.session.master for one in now if one.session.reads], [], [], 0.01)
        for one in list(now):
            if one.go_on():
                continue
            now.remove(one)
            count += 1
            if one.session.error:
                failures += 1
                print(f'FAILED: {one.session.what}: {one.session.error}', flush=True)
            one.session.close()
    print(f'signals: {count} ways out,', 'all passed' if not failures else f'{failures} failures')
    return failures > 0


sys.exit(main())
