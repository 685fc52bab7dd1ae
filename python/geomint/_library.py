# SPDX-License-Identifier: GPL-3.0-or-later
"""libgeomint.so, found, loaded and checked; its statuses as exceptions."""
import os

from ._version import __version__

try:
    import numpy  # noqa: F401
except ImportError as error:
    raise ImportError("geomint needs NumPy (in Debian: python3-numpy)") from error
try:
    import cffi
except ImportError as error:
    raise ImportError("geomint needs cffi (in Debian: python3-cffi)") from error

DECLARATIONS = """
typedef struct geomint geomint;
const char *geomint_version(void);
geomint *geomint_open(int count, const char *const words[]);
geomint *geomint_scheme(const char *word);
geomint *geomint_certify(const char *scheme, int count, const char *const words[]);
void geomint_close(geomint *handle);
int geomint_status(const geomint *handle);
const char *geomint_message(const geomint *handle);
const char *geomint_text(geomint *handle);
const char *geomint_scene_name(size_t index);
const char *geomint_scheme_name(size_t index);
size_t geomint_lanes(const geomint *handle);
int geomint_step(geomint *handle, size_t lane, int64_t steps);
int geomint_until(geomint *handle, size_t lane, double t);
double geomint_time(const geomint *handle, size_t lane);
int64_t geomint_steps(const geomint *handle, size_t lane);
int64_t geomint_steps_left(const geomint *handle, size_t lane);
const double *geomint_state(geomint *handle, size_t lane, size_t *n, size_t *m);
int geomint_observe(geomint *handle, const char *keys);
size_t geomint_columns(const geomint *handle, size_t lane);
const char *geomint_column_name(const geomint *handle, size_t lane, size_t column);
const char *geomint_column_unit(const geomint *handle, size_t lane, size_t column);
size_t geomint_column_shape(const geomint *handle, size_t lane, size_t column, size_t shape[3]);
int geomint_column(geomint *handle, size_t lane, size_t column, double *values);
int geomint_observable(geomint *handle, size_t lane, const char *key, double *value);
size_t geomint_row_size(const geomint *handle, size_t lane);
int geomint_row(geomint *handle, size_t lane, double *t, double *values);
int geomint_rows(geomint *handle, size_t lane, int64_t every, size_t rows, double *t, double *values, size_t *made);
geomint *geomint_explore(int count, const char *const words[]);
int geomint_advance(geomint *handle, double t);
int geomint_forward(geomint *handle);
int geomint_back(geomint *handle);
int geomint_reverse(geomint *handle);
int geomint_visit(geomint *handle, double passed);
int geomint_restart(geomint *handle);
int geomint_undo(geomint *handle);
int geomint_switch(geomint *handle, size_t lane, const char *scheme);
int geomint_fork(geomint *handle, size_t lane, const char *scheme);
int geomint_add(geomint *handle, size_t lane, const char *scheme);
int geomint_remove(geomint *handle, size_t lane);
int geomint_set(geomint *handle, size_t lane, const char *key, const char *value);
int geomint_slide(geomint *handle, size_t lane, const char *key, double position);
int geomint_press(geomint *handle, const char *key);
const char *geomint_view(geomint *handle);
const char *geomint_schemes(geomint *handle);
const char *geomint_commands(geomint *handle);
int geomint_point(geomint *handle, double across, double down);
int geomint_look(geomint *handle, double azimuth, double elevation, double zoom);
int geomint_change(geomint *handle, size_t lane, int64_t step, const char *change);
int geomint_theme(geomint *handle, const char *name);
int geomint_grade(geomint *handle, const char *tour, size_t step);
const char *geomint_answer(geomint *handle, const char *tour, size_t step);
int geomint_draw(geomint *handle, int width, int height, double scale, unsigned char *rgba);
int geomint_save(geomint *handle, const char *path, int width, int height, double scale, const char *title);
"""

OK, USAGE, NUMERICAL, FILE, CLAIM, MEMORY = range(6)


class GeomintError(Exception):
    """What geomint refuses; the text is its sentence."""


class UsageError(GeomintError, ValueError):
    """Something wrong was asked for: an unknown key, a scheme that does not fit, a formula with a mistake."""


class FileError(GeomintError, OSError):
    """A file could not be read or written, or a picture not be painted."""


class ClosedError(GeomintError, ValueError):
    """A run was used after it was closed."""


def numbers_of(version):
    """0.1.0 -> (0, 1, 0)"""
    return tuple(int(part) for part in version.split(".") if part.isdigit())


def load():
    try:
        from ._where import LIBRARY as installed  # written by the installation
    except ImportError:
        installed = ""
    ffi = cffi.FFI()
    ffi.cdef(DECLARATIONS)
    built = os.path.join(os.path.dirname(__file__), "..", "..", "build", "library", "libgeomint.so.1")
    there = [path for path in (installed, built) if os.path.exists(path)]
    path = os.environ.get("GEOMINT_LIBRARY") or (there[0] if there else "libgeomint.so.1")
    try:
        library = ffi.dlopen(path)
        found = ffi.string(library.geomint_version()).decode()
    except (OSError, AttributeError) as error:
        raise ImportError(f"libgeomint could not be loaded: {error}; install geomint, or set GEOMINT_LIBRARY") from error
    if numbers_of(found) < numbers_of(__version__):
        raise ImportError(f"libgeomint {found} ({path}) is older than this package, {__version__}: "
                          "install the geomint that it came with")
    return ffi, library


ffi, library = load()


def text_of(characters):
    return None if characters == ffi.NULL else ffi.string(characters).decode()


def characters(text):
    """A text or a path for C, which ends at a zero byte; bytes of a path that are not UTF-8 stay unchanged."""
    try:
        coded = os.fspath(text).encode("utf-8", "surrogateescape")
    except (AttributeError, TypeError) as error:
        raise UsageError(f"{text!r} is not a text") from error
    except UnicodeEncodeError as error:
        raise UsageError(f"{text!r} cannot be encoded in UTF-8") from error
    if b"\0" in coded:
        raise UsageError(f"{text!r} holds a zero byte")
    return ffi.new("char[]", coded)


def words_of(words):
    """An array for C, and what it points to."""
    kept = [characters(word) for word in words]
    return ffi.new("char *[]", kept or [ffi.NULL]), kept


def check(handle, status=None):
    """Raises the error of the last call of a handle; a failed lane is reported by its status, not by an exception."""
    if status is None:
        status = library.geomint_status(handle)
    if status == MEMORY:
        raise MemoryError(text_of(library.geomint_message(handle)))
    if status in (USAGE, FILE):
        raise (UsageError if status == USAGE else FileError)(text_of(library.geomint_message(handle)))
    return status


def owned(handle):
    """A handle that is closed with the last object that needs it."""
    if handle == ffi.NULL:
        raise MemoryError("there is not enough memory")
    handle = ffi.gc(handle, library.geomint_close)
    check(handle)
    return handle
