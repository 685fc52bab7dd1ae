/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libgeomint: geometric integrators with their scenes, systems of one's own, measurements and pictures.

   A handle holds what words ask for, as on the command line of the program: a scene or a system first, then
   key=value; lists of values make several lanes. Nothing here prints, ends the program, or touches its
   signals, its locale, GSL's error handler, or an OpenGL context that is current. Handles of different
   threads are independent; one handle is used by one thread at a time; pictures of all threads are drawn one
   after the other.

       geomint *run = geomint_open(3, (const char *[]){"kepler", "scheme=verlet", "dt=0.01"});
       geomint_until(run, 0, 100);
       const double *y = geomint_state(run, 0, NULL, NULL);
       geomint_close(run);

   What refuses returns a status that is not 0, and the handle has a sentence (geomint_message). Lanes are
   numbered from 0 on, and a lane that there is not is refused: GEOMINT_USAGE, or NULL, 0, NaN from what
   returns no status. Times are in the scene's unit (the key "units" of geomint_text), other numbers in the
   column's. Texts are UTF-8, belong to the handle, and stay until it is closed, where nothing else is said.

   A NULL handle is what geomint_open returns for want of memory, and can be given to every function: it has
   no lanes, its status is GEOMINT_MEMORY, which calls that return a status return, and closing it does
   nothing. Where a pointer to words or for numbers is NULL, and may not be, that is refused like any other
   mistake; that an array is too short nobody can see.

   A process that is forked off goes on with the handles that it has got, if no other thread was in the
   library at that moment. Where its parent has painted, OpenGL's threads are not there: the own rasteriser paints, and
   GEOMINT_PAINTER=osmesa is refused (GEOMINT_FILE). */
#ifndef GEOMINT_H
#define GEOMINT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The same as the program's exit statuses. */
enum {
    GEOMINT_OK = 0,
    GEOMINT_USAGE = 1, /* something wrong was asked for: an unknown key, a scheme that does not fit */
    GEOMINT_NUMERICAL =
        2,            /* the lane has ended: it blew up, or its equations were not solved. Its numbers stay */
    GEOMINT_FILE = 3, /* a file could not be read or written */
    GEOMINT_CLAIM = 4, /* a scheme does not keep what it claims */
    GEOMINT_MEMORY = 5,
};

typedef struct geomint geomint;

/* ---- opening and closing ---- */

/* "0.1.0", for ever. */
const char *geomint_version(void);

/* Opens `count` words: a scene's name, the name or the path of a system, or "system" with "H=p^2/2 - cos(q)"
   or another formula; then key=value. NULL: not even for the handle is there memory; else geomint_status says
   whether it is good, and a handle that is not has no lanes. To be closed in both cases. The words are
   copied. */
geomint *geomint_open(int count, const char *const words[]);

/* Opens what is known of a scheme: a name, the path of a .scheme file, or a word, "composition(verlet; 1/2,
   1/2)". It has no lanes, but a text. */
geomint *geomint_scheme(const char *word);

/* Measures the claims of a scheme, and asks theory; with words (`count` > 0) on that scene or system. This
   may take seconds. It has no lanes, but a text; its status is GEOMINT_CLAIM where a claim is broken. */
geomint *geomint_certify(const char *scheme, int count, const char *const words[]);

/* All pointers that were got of it end here, arrays and texts. NULL does nothing. */
void geomint_close(geomint *handle);

/* How the last call went, and a sentence on it of at most 511 bytes; "" where all is well. Calls that take a
   const handle change neither. */
int geomint_status(const geomint *handle);
const char *geomint_message(const geomint *handle);

/* What the handle is of, as JSON: an array with an object for each lane (scene, scheme, parameters, units,
   status, t, steps, evaluations); of a scheme or a certificate an object, as `geomint list` and `geomint
   certify` print it. It stays as it is until asked for once more. NULL: there is no memory, or nothing. */
const char *geomint_text(geomint *handle);

/* Names of scenes and of schemes, NULL behind the last; for ever. Schemes for different problems may share a
   name. */
const char *geomint_scene_name(size_t index);
const char *geomint_scheme_name(size_t index);

/* ---- driving a lane ---- */

/* How many lanes there are; 0 of what was refused, of a scheme and of a certificate. */
size_t geomint_lanes(const geomint *handle);

/* Makes up to so many steps, 1e15 in all at most; none are less than one. A lane that has failed, or come to
   its `stop`, makes none; of one that has failed the status stays GEOMINT_NUMERICAL. */
int geomint_step(geomint *handle, size_t lane, int64_t steps);
/* Goes on to the step nearest to the time t, a finite number; where the scheme chooses its steps to the first
   that is not before it. It makes no step where that lies behind. */
int geomint_until(geomint *handle, size_t lane, double t);

/* The present time (NaN: there is no such lane), and the steps made so far. */
double geomint_time(const geomint *handle, size_t lane);
int64_t geomint_steps(const geomint *handle, size_t lane);
/* How many steps lie between here and the end that the words ask for (until=, steps=); -1 where the scheme
   chooses them, and the end is not reached. 0: the lane is there, or has ended before. */
int64_t geomint_steps_left(const geomint *handle, size_t lane);

/* The present state, *n components of *m members, [component * m + member]. The pointer is the same until the
   handle is closed, and shows the present state after each call that drives. n, m may be NULL. NULL: there is
   no such lane, or no memory. */
const double *geomint_state(geomint *handle, size_t lane, size_t *n, size_t *m);

/* ---- rows of numbers ---- */

/* A row holds what the state is made of, as named arrays (q, p, u ...), and behind these observables. Chooses
   the observables of all lanes by their keys, "energy_error,angular_momentum_error"; NULL: those that a scene
   tells unasked, which is so at first; "": none. */
int geomint_observe(geomint *handle, const char *keys);

/* The columns of a row, and after them (from geomint_columns on) those that are the same at all times, as the
   nodes of a grid: these stand in no row. NULL, 0: there are no more. */
size_t geomint_columns(const geomint *handle, size_t lane);
const char *geomint_column_name(const geomint *handle, size_t lane, size_t column);
const char *geomint_column_unit(const geomint *handle, size_t lane, size_t column);
/* The lengths of its axes; their number is returned, 0 for a single number. */
size_t geomint_column_shape(const geomint *handle, size_t lane, size_t column, size_t shape[3]);
/* Its numbers now: as many as the product of the lengths, 1 of a single one; the last axis changes
   fastest. */
int geomint_column(geomint *handle, size_t lane, size_t column, double *values);
/* An observable now, chosen or not; NaN: it has none there. */
int geomint_observable(geomint *handle, size_t lane, const char *key, double *value);

/* How many numbers a row has: those of its columns, one after another. It changes with geomint_observe
   alone. */
size_t geomint_row_size(const geomint *handle, size_t lane);
/* Writes the present state as a row, and its time; t may be NULL. */
int geomint_row(geomint *handle, size_t lane, double *t, double *values);
/* Goes on towards the end that the words ask for, and writes a row after every `every` steps, counted from
   the start, and one at the end: at most `rows` of them into t (rows) and values (rows * geomint_row_size).
   `every` is at least 1. `made` (or NULL) is how many there are: fewer where the end is reached, or the lane
   failed. */
int geomint_rows(geomint *handle, size_t lane, int64_t every, size_t rows, double *t, double *values,
                 size_t *made);

/* ---- pictures ---- */

/* Draws all lanes as they are now into rgba: height rows of width * 4 bytes, the top row first; red, green,
   blue, and 255. Width and height are from 64 to 16384 pixels. A scene may show its past, so the steps made
   so far are made once more beside the lanes, looked at one by one, when it is first drawn. `scale` is that
   of letters and lines, from 1/4 to 4; 0: 1. What paints is OSMesa, where it can be loaded, or what the
   environment variable GEOMINT_PAINTER names: auto, osmesa, egl or own. GEOMINT_USAGE: it names another, or one
   that cannot be loaded; GEOMINT_FILE: there is no font. */
int geomint_draw(geomint *handle, int width, int height, double scale, unsigned char *rgba);
/* Writes the picture to a file whose name ends with .png, .svg or .pdf, and which tells how it was made;
   folders that are missing are made. Width, height and scale as above; of .svg and .pdf pixels are 1/96 inch.
   title NULL: the scene's; else it is not empty, and holds no control characters. */
int geomint_save(geomint *handle, const char *path, int width, int height, double scale, const char *title);

#ifdef __cplusplus
}
#endif

#endif
