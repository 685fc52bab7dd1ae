# SPDX-License-Identifier: GPL-3.0-or-later
"""A terminal with sixels or Kitty's images, as far as geomint uses one: runs a program in a pty, answers what it
asks, keeps the text and the pixels of its screen. Written from the protocols' descriptions (DEC's VT340 manual,
Kitty's graphics protocol, xterm's control sequences); shares nothing with the program."""
import base64
import fcntl
import os
import pty
import re
import select
import signal
import struct
import termios
import time
import zlib


def read_png(path):
    """(width, height, rows of RGB bytes) of a PNG with 8 bits a channel, not interlaced."""
    data = open(path, 'rb').read()
    assert data[:8] == b'\x89PNG\r\n\x1a\n'
    at, packed = 8, b''
    while at < len(data):
        size, kind = struct.unpack('>I4s', data[at:at + 8])
        if kind == b'IHDR':
            width, height, depth, colours, _, _, interlaced = struct.unpack('>IIBBBBB', data[at + 8:at + 21])
            assert (depth, colours, interlaced) == (8, 2, 0)
        elif kind == b'IDAT':
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, stride, rows, above = zlib.decompress(packed), width * 3, [], bytes(width * 3)
    for y in range(height):
        method, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride if method else 0):
            left = line[i - 3] if i >= 3 else 0
            up, corner = above[i], above[i - 3] if i >= 3 else 0
            if method == 4:
                guess = left + up - corner
                far = abs(guess - left), abs(guess - up), abs(guess - corner)
                line[i] = (line[i] + (left, up, corner)[far.index(min(far))]) & 255
            else:
                line[i] = (line[i] + (left, up, (left + up) // 2)[method - 1]) & 255
        above = bytes(line)
        rows.append(above)
    return width, height, rows


def decode_sixel(body):
    """(width, height, rows) of a sixel picture; rows are lists of (r, g, b) or None. Colours are percents."""
    raster = re.match(r'[^q]*q"(\d+);(\d+);(\d+);(\d+)', body)
    assert raster, body[:40]
    assert raster[1] == raster[2] == '1', 'pixels are not square'
    width, height = int(raster[3]), int(raster[4])
    rows = [[None] * width for _ in range(height)]
    colours, colour, x, y = {}, None, 0, 0
    for token in re.finditer(r'#(\d+)(?:;2;(\d+);(\d+);(\d+))?|!(\d+)([?-~])|([?-~])|(\$)|(-)', body[raster.end():]):
        if token[1]:
            if token[2]:
                colours[token[1]] = tuple(round(int(token[i]) * 2.55) for i in (2, 3, 4))
            colour = colours[token[1]]
        elif token[8]:
            x = 0
        elif token[9]:
            x, y = 0, y + 6
        else:
            count, bits = int(token[5] or 1), ord(token[6] or token[7]) - 63
            for i in range(6):
                if bits >> i & 1 and y + i < height:
                    assert x + count <= width, 'a sixel beyond the right edge'
                    rows[y + i][x:x + count] = [colour] * count
            x += count
    return width, height, rows


class Terminal:
    def __init__(self, command, columns=160, rows=45, cell=(10, 20), kind='sixel', sizes='system', delay=0,
                 typed=b'', limits=None, environment=None, synchronised=True,
                 rate=None, background=None, true_colour=False, registers=1024):
        """kind: sixel, kitty or plain. sizes: who knows the size of a cell, 'system', 'terminal' or 'nobody'.
        delay: of every answer, in seconds. typed: keys that are there when the program begins. rate: bytes a second
        that it reads, at the end of a line that takes any number. background: what it answers, as rgb:.
        true_colour: it keeps colours of 24 bits. registers: colours of a sixel picture that it begins with, up to
        1024 where it is asked for more."""
        self.columns, self.rows, self.cell, self.kind, self.sizes = columns, rows, cell, kind, sizes
        self.delay, self.limits, self.synchronised = delay, limits, synchronised
        self.rate, self.background, self.true_colour, self.registers = rate, background, true_colour, registers
        self.raised = False  # it was asked for another number of registers
        self.queue, self.read_on = b'', 0  # what is on its way where it reads slowly, and when it read last
        self.pending, self.answers, self.output = b'', [], 0
        self.text = [[' '] * columns for _ in range(rows)]
        self.pixels = [[None] * (columns * cell[0]) for _ in range(rows * cell[1])]
        self.tiles, self.images, self.partial = {}, 0, None
        self.x = self.y = 0
        self.together = False
        self.status = None
        self.frames = []  # bytes of each synchronised frame
        self.begun = 0
        self.questions = []
        environ = dict(os.environ, TERM='xterm-256color', COLORTERM='truecolor', LC_ALL='C.UTF-8')
        for name in list(environ):
            if name.startswith('GEOMINT_') or name in ('TMUX', 'NO_COLOR', 'COLORFGBG'):
                del environ[name]
        environ.update(environment or {})
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            os.read(0, 1)  # until the size is set
            os.execve(command[0], command, environ)
        self.resize(columns, rows)
        attributes = termios.tcgetattr(self.master)
        os.write(self.master, b'\n')
        time.sleep(0.05)
        assert attributes
        if typed:
            os.write(self.master, typed)

    def resize(self, columns, rows):
        self.columns, self.rows = columns, rows
        self.text = [[' '] * columns for _ in range(rows)]
        self.pixels = [[None] * (columns * self.cell[0]) for _ in range(rows * self.cell[1])]
        size = (columns * self.cell[0], rows * self.cell[1]) if self.sizes == 'system' else (0, 0)
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack('HHHH', rows, columns, *size))

    # ---- the pty ----

    def keys(self, text):
        os.write(self.master, text.encode())

    def answer(self, text):
        self.answers.append((time.monotonic() + self.delay, text.encode()))

    def run(self, seconds, until=None):
        """Reads for so long, or until the condition holds. True if it did."""
        end = time.monotonic() + seconds
        while True:
            now = time.monotonic()
            while self.answers and self.answers[0][0] <= now:
                os.write(self.master, self.answers.pop(0)[1])
            if until and not self.pending and not self.together and until():
                return True
            left = end - now
            if self.answers:
                left = min(left, self.answers[0][0] - now)
            if self.queue:
                left = min(left, 0.02)
            if end <= now:
                return False
            if select.select([self.master], [], [], max(left, 0))[0]:
                try:
                    data = os.read(self.master, 65536)
                except OSError:
                    data = b''
                if not data:
                    self.status = os.waitpid(self.pid, 0)[1]
                    return bool(until and until())
                self.output += len(data)
                self.queue += data
                self.read_on = max(self.read_on, now - 0.02)
            passed = time.monotonic() - self.read_on
            if self.queue and (not self.rate or passed >= 0.01):
                count = int(passed * self.rate) if self.rate else len(self.queue)
                self.pending += self.queue[:count]
                self.queue = self.queue[count:]
                self.read_on += passed
                self.parse()

    def until(self, condition):
        """Reads until the condition holds. True if it did: a machine may be slow, but not for ever."""
        return self.run(60, condition)

    def settle(self, seconds=20):
        """Until nothing was written for a while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            before = self.output
            self.run(0.7 + 2 * self.delay)
            if self.output == before:
                return True
        return False

    def close(self):
        if self.status is None:
            os.kill(self.pid, signal.SIGKILL)
            self.status = os.waitpid(self.pid, 0)[1]
        os.close(self.master)

    # ---- the screen ----

    def line(self, row):
        return ''.join(self.text[row])

    def shows(self, text):
        return any(text in self.line(row) for row in range(self.rows))

    def picture(self):
        """The pixels of the screen, a list of rows; None where there is text or nothing."""
        if self.kind != 'kitty':
            return self.pixels
        rows = [[None] * (self.columns * self.cell[0]) for _ in range(self.rows * self.cell[1])]
        for x, y, width, height, rgb in self.tiles.values():
            for i in range(height):
                at = i * width * 3
                line = rgb[at:at + width * 3]
                rows[y + i][x:x + width] = list(zip(line[0::3], line[1::3], line[2::3]))
        return rows

    def letter(self, letter):
        if self.x >= self.columns:
            self.x, self.y = 0, min(self.y + 1, self.rows - 1)
        self.text[self.y][self.x] = letter
        width, height = self.cell
        if self.pixels[self.y * height][self.x * width] is not None:
            for y in range(self.y * height, (self.y + 1) * height):  # text takes the place of sixels
                self.pixels[y][self.x * width:(self.x + 1) * width] = [None] * width
        self.x += 1

    # ---- the language ----

    tokens = re.compile(
        rb'\x1b\[([?<=>]?)([0-9;:]*)([ -/]*)([@-~])'  # CSI
        rb'|\x1bP(.*?)\x1b\\'  # DCS
        rb'|\x1b_(.*?)\x1b\\'  # APC
        rb'|\x1b\](.*?)(?:\x07|\x1b\\)'  # OSC
        rb'|\x1b[ -/]*([0-OQ-Z\\^`-~])'  # others
        rb'|([\x00-\x1a\x1c-\x1f])'
        rb'|([\x20-\x7e]|[\xc2-\xdf][\x80-\xbf]|[\xe0-\xef][\x80-\xbf]{2}|[\xf0-\xf4][\x80-\xbf]{3})',
        re.DOTALL)

    def parse(self):
        at = 0
        while True:
            token = self.tokens.match(self.pending, at)
            if not token:
                break
            if token[4]:
                self.control(token[1].decode(), token[2].decode(), (token[3] + token[4]).decode())
            elif token[5] == b'$qm':
                colour = '48:2::1:2:3' if self.true_colour else '48:5:16'
                self.answer(f'\x1bP1$r0;{colour}m\x1b\\')
            elif token[5] is not None:
                self.sixel(token[5].decode('latin-1'))
            elif token[6] is not None:
                self.kitty(token[6])
            elif token[7] is not None:
                self.command(token[7].decode())
            elif token[9]:
                self.special(token[9])
            elif token[10]:
                self.letter(token[10].decode())
            at = token.end()
            if self.together:
                self.begun += token.end() - token.start()
        self.pending = self.pending[at:]
        assert len(self.pending) < 8 << 20

    def command(self, text):
        self.questions.append(text)
        if text == '11;?' and self.background:
            self.answer(f'\x1b]11;rgb:{self.background}\x07')

    def special(self, byte):
        if byte == b'\r':
            self.x = 0
        elif byte == b'\n':
            self.y = min(self.y + 1, self.rows - 1)
        elif byte == b'\b':
            self.x = max(self.x - 1, 0)

    def control(self, private, numbers, end):
        values = [int(n) if n else 0 for n in numbers.split(';')] if numbers else []
        if private == '?' and end in 'hl' and values == [2026]:
            self.together = end == 'h'
            if end == 'h':
                self.begun = 0
            else:
                self.frames.append(self.begun)
        elif private == '' and end == 'H':
            self.y = min((values[0] if values else 1) - 1, self.rows - 1)
            self.x = min((values[1] if len(values) > 1 else 1) - 1, self.columns - 1)
        elif private == '' and end in 'JK':
            first = self.y if end == 'K' else 0 if values == [2] else self.y
            for row in range(first, self.y + 1 if end == 'K' else self.rows):
                self.text[row] = [' '] * self.columns
                for y in range(row * self.cell[1], (row + 1) * self.cell[1]):
                    self.pixels[y] = [None] * (self.columns * self.cell[0])
        elif end == 'c' and private == '':
            self.answer('\x1b[?62;4;22c' if self.kind == 'sixel' else '\x1b[?62;22c')
        elif end == 'n' and values == [5]:
            self.answer('\x1b[0n')
        elif end == '$p' and private == '?':
            self.answer(f'\x1b[?{values[0]};{2 if self.synchronised else 0}$y')
        elif end == 'S' and private == '?' and self.kind == 'sixel':
            if values[0] == 1:
                self.raised |= values[1] == 3
                self.registers = min(values[2], 1024) if values[1] == 3 else self.registers
                self.answer(f'\x1b[?1;0;{self.registers}S')
            elif values[0] == 2 and self.limits:
                self.answer(f'\x1b[?2;0;{self.limits[0]};{self.limits[1]}S')
        elif end == 't' and values == [16] and self.sizes == 'terminal':
            self.answer(f'\x1b[6;{self.cell[1]};{self.cell[0]}t')
        elif end == 't' and values == [14] and self.sizes == 'terminal':
            self.answer(f'\x1b[4;{self.cell[1] * self.rows};{self.cell[0] * self.columns}t')

    def sixel(self, body):
        assert self.kind == 'sixel', 'sixels for a terminal without'
        assert self.together, 'a picture outside synchronised output'
        width, height, rows = decode_sixel(body)
        assert len({colour for row in rows for colour in row}) <= self.registers, 'more colours than registers'
        if self.limits:
            assert width <= self.limits[0] and height <= self.limits[1], 'the picture is too large'
        left, top = self.x * self.cell[0], self.y * self.cell[1]
        assert top + height <= (self.rows - 1) * self.cell[1], 'the screen would scroll'
        for i, row in enumerate(rows):
            line = self.pixels[top + i]
            line[left:left + width] = [new or old for new, old in zip(row, line[left:left + width])]
        for row in range(self.y, self.y + -(-height // self.cell[1])):
            for column in range(self.x, self.x + width // self.cell[0]):
                self.text[row][column] = ' '
        self.images += 1

    def kitty(self, body):
        assert body[:1] == b'G'
        keys, _, payload = body[1:].partition(b';')
        keys = dict(pair.split('=') for pair in keys.decode().split(',')) if keys else {}
        if keys.get('a') == 'q':
            self.questions.append('kitty')
            if self.kind == 'kitty':
                self.answer(f'\x1b_Gi={keys["i"]};OK\x1b\\')
            return
        assert self.kind == 'kitty', 'images for a terminal without'
        assert int(keys.get('z', 0)) >= 0, 'below the text Kitty 0.26 draws its window wrong'
        if keys.get('a') == 'd':
            assert keys['d'] == 'A'
            self.tiles = {}
            return
        assert self.together, 'a picture outside synchronised output'
        assert len(payload) <= 4096
        if self.partial is None:
            assert keys['a'] == 'T' and keys['f'] == '24' and keys['o'] == 'z' and keys['q'] == '2'
            self.partial = keys, b'', self.x, self.y
        first, so_far, x, y = self.partial
        self.partial = first, so_far + payload, x, y
        if keys['m'] == '1':
            assert len(payload) % 4 == 0
            return
        rgb = zlib.decompress(base64.b64decode(self.partial[1], validate=True))
        width, height = int(first['s']), int(first['v'])
        assert len(rgb) == width * height * 3
        assert width == int(first['c']) * self.cell[0] and height == int(first['r']) * self.cell[1]
        self.tiles[first['i']] = x * self.cell[0], y * self.cell[1], width, height, rgb
        self.partial = None
        self.images += 1
