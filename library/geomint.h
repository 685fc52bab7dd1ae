/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libgeomint: geometric integrators with their scenes, user-defined systems, measurements and pictures.

   A handle is opened by words, as on the command line of the program: a scene or a system first, then
   key=value; lists of values make several lanes. Nothing here prints, ends the program, or changes its
   signals, its locale, GSL's error handler, or the current OpenGL context. Handles of different threads are
   independent; only one thread at a time may use a handle; pictures of all threads are drawn one after the
   other.

       geomint *run = geomint_open(3, (const char *[]){"kepler", "scheme=verlet", "dt=0.01"});
       geomint_until(run, 0, 100);
       const double *y = geomint_state(run, 0, NULL, NULL);
       geomint_close(run);

   A call that fails returns a status other than 0, and the handle has a sentence (geomint_message). Lanes are
   numbered from 0. A lane that does not exist is refused: GEOMINT_USAGE, or NULL, 0 or NaN from a function
   that returns no status. Times are in the scene's unit (the key "units" of geomint_text), other numbers in
   the unit of their column. Texts are UTF-8, belong to the handle, and by default stay until it is closed.

   geomint_open returns NULL when out of memory, and every function accepts NULL. Such a handle has no lanes,
   its status is GEOMINT_MEMORY, calls return this status, and closing it does nothing. A forbidden NULL
   pointer to words or numbers is refused like any other mistake. The library cannot detect an array that is
   too short.

   A forked process may use the handles of its parent, if no other thread was in the library at that moment.
   If the parent has painted, the threads of OpenGL do not exist in the child: geomint's own rasteriser
   paints, and GEOMINT_PAINTER=osmesa is refused (GEOMINT_FILE). */
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
    GEOMINT_USAGE = 1, /* wrong arguments: an unknown key, a scheme that does not fit */
    GEOMINT_NUMERICAL =
        2,             /* the lane has failed: blow-up, or equations that were not solved. Its numbers stay */
    GEOMINT_FILE = 3,  /* a file could not be read or written */
    GEOMINT_CLAIM = 4, /* a claim of a scheme is broken */
    GEOMINT_MEMORY = 5,
};

typedef struct geomint geomint;

/* ---- opening and closing ---- */

/* Returns the version, "0.1.0": a static string. */
const char *geomint_version(void);

/* Opens `count` words: a scene's name, the name or the path of a system, or "system" with "H=p^2/2 - cos(q)"
   or another formula; then key=value. Returns NULL when there is no memory for the handle. If the words are
   refused, the handle has no lanes, and geomint_status gives the status. The caller closes it in both cases.
   The words are copied. */
geomint *geomint_open(int count, const char *const words[]);

/* Opens a scheme: a name, the path of a .scheme file, or a word, "composition(verlet; 1/2, 1/2)". The handle
   has a text and no lanes. */
geomint *geomint_scheme(const char *word);

/* Measures the claims of a scheme and checks them by theory; with words (`count` > 0) on that scene or system.
   This may take seconds. The handle has a text and no lanes. The status is GEOMINT_CLAIM if a claim is
   broken. */
geomint *geomint_certify(const char *scheme, int count, const char *const words[]);

/* Closes a handle. All its pointers, to arrays and texts, become invalid. NULL does nothing. */
void geomint_close(geomint *handle);

/* Return the status of the last call, and a sentence of at most 511 bytes; "" after success. Calls with a
   const handle change neither. */
int geomint_status(const geomint *handle);
const char *geomint_message(const geomint *handle);

/* Returns a description of the handle as JSON: an array with an object for each lane (scene, scheme, parameters,
   units, status, t, steps, evaluations, engine); for a scheme or a certificate an object, as `geomint list` and
   `geomint certify` print it. The text is valid until the next call of this function. Returns NULL when out of
   memory, or without anything to describe. */
const char *geomint_text(geomint *handle);

/* Return the names of scenes and of schemes, static strings; NULL after the last. Schemes for different
   problems may share a name. */
const char *geomint_scene_name(size_t index);
const char *geomint_scheme_name(size_t index);

/* ---- driving a lane ---- */

/* Returns the number of lanes; 0 for refused words, a scheme or a certificate. */
size_t geomint_lanes(const geomint *handle);

/* Makes up to `steps` steps, at most 1e15 in total; without effect below 1. A lane that has failed or has
   reached its `stop` makes no step. The status of a failed lane stays GEOMINT_NUMERICAL. */
int geomint_step(geomint *handle, size_t lane, int64_t steps);
/* Advances the lane to the step nearest to t; an adaptive scheme stops at the first step at or after t. Does
   nothing if t has passed. t must be finite. */
int geomint_until(geomint *handle, size_t lane, double t);

/* Return the current time (NaN if the lane does not exist), and the number of steps made so far. */
double geomint_time(const geomint *handle, size_t lane);
int64_t geomint_steps(const geomint *handle, size_t lane);
/* Returns the number of steps left before the end given by the words (until=, steps=), 0 if the lane has ended,
   -1 for an adaptive scheme before its end. */
int64_t geomint_steps_left(const geomint *handle, size_t lane);

/* Returns the current state, *n components of *m members, [component * m + member]. The pointer stays the same
   until the handle is closed, and shows the current state after each step. n and m may be NULL. Returns NULL
   if the lane does not exist, or when out of memory. */
const double *geomint_state(geomint *handle, size_t lane, size_t *n, size_t *m);

/* ---- rows of numbers ---- */

/* Chooses the observables of all lanes by their keys, "energy_error,angular_momentum_error"; NULL: the default
   ones of the scene, as after opening; "": none. A row holds the components of the state as named arrays (q,
   p, u ...), followed by these observables. */
int geomint_observe(geomint *handle, const char *keys);

/* Return the number of columns of a row, and the name and unit of a column. Columns from that number on are
   constant in time, such as the nodes of a grid, and are not a part of a row. NULL after the last. */
size_t geomint_columns(const geomint *handle, size_t lane);
const char *geomint_column_name(const geomint *handle, size_t lane, size_t column);
const char *geomint_column_unit(const geomint *handle, size_t lane, size_t column);
/* Writes the lengths of a column's axes. Returns the number of axes, 0 for a single number. */
size_t geomint_column_shape(const geomint *handle, size_t lane, size_t column, size_t shape[3]);
/* Writes the current numbers of a column: the product of its lengths, or 1. The last axis changes fastest. */
int geomint_column(geomint *handle, size_t lane, size_t column, double *values);
/* Writes the current value of an observable, chosen or not; NaN if it has no value. */
int geomint_observable(geomint *handle, size_t lane, const char *key, double *value);

/* Returns the number of numbers in a row, the sum over its columns. Only geomint_observe changes it. */
size_t geomint_row_size(const geomint *handle, size_t lane);
/* Writes the current state as a row, and its time; t may be NULL. */
int geomint_row(geomint *handle, size_t lane, double *t, double *values);
/* Advances towards the end given by the words, and writes a row after every `every` steps, counted from the
   start, and one at the end: at most `rows` of them into t (rows) and values (rows * geomint_row_size).
   `every` is at least 1. *made (or NULL) is the number of rows, fewer at the end or if the lane failed. */
int geomint_rows(geomint *handle, size_t lane, int64_t every, size_t rows, double *t, double *values,
                 size_t *made);

/* Adds a change to a lane that geomint_open has opened: "scheme=rk4" or "dt=0.1" after its first `step` steps, which are
   not made yet. Changes are added in the order of their steps, as `geomint render --changes` lists them. */
int geomint_change(geomint *handle, size_t lane, int64_t step, const char *change);

/* ---- exploring ---- */

/* Opens words as the explorer does: lanes that advance together and can be changed during the run; by default with
   the scene's first three schemes. The functions for rows and pictures serve these lanes too, but geomint_step and
   geomint_until are refused, geomint_rows makes no row, and the pointer of geomint_state is valid until the next
   function below. The functions return GEOMINT_USAGE, and change nothing, if something does not fit, and
   GEOMINT_NUMERICAL if a lane has failed; the other lanes continue.

       geomint *lab = geomint_explore(2, (const char *[]){"kepler", "scheme=verlet"});
       geomint_advance(lab, 10);
       geomint_fork(lab, 0, "rk4");
       geomint_advance(lab, 20);
       puts(geomint_view(lab)); */
geomint *geomint_explore(int count, const char *const words[]);

/* Advance all lanes by the steps that end at or before the time t, without effect if it has passed; make the next
   step; take it back. */
int geomint_advance(geomint *handle, double t);
int geomint_forward(geomint *handle);
int geomint_back(geomint *handle);
/* Lets time run the other way from here, dt to -dt; a second call lets it run forwards again. */
int geomint_reverse(geomint *handle);
/* Turns back to the last stored state at or before `passed`, the model time that the lanes have passed in both
   directions: t - t0 until time is reversed. Later states can be visited too until a lane advances or is changed. */
int geomint_visit(geomint *handle, double passed);
/* Restarts all lanes with their current schemes and parameters. */
int geomint_restart(geomint *handle);
/* Undoes the last change of a parameter or of a scheme; at most 32 are stored. */
int geomint_undo(geomint *handle);

/* Continue a lane with another scheme: itself, or a copy, which is the new last lane. A scheme is a name, the path of
   a .scheme file, or a word. */
int geomint_switch(geomint *handle, size_t lane, const char *scheme);
int geomint_fork(geomint *handle, size_t lane, const char *scheme);
/* Adds a last lane at its start, with the parameters of `lane`. There are at most six lanes. */
int geomint_add(geomint *handle, size_t lane, const char *scheme);
/* Removes a lane; the numbers of the later ones become smaller. The last lane stays. */
int geomint_remove(geomint *handle, size_t lane);

/* Set a parameter of the scene or of its schemes: to a value as it is typed, "0.01", "pi/12" (NULL: the default), or
   to a position from 0 to 1 in its range. It is set in all lanes, or only in `lane` if they differ in it. A live
   parameter acts at once; for another one all lanes restart. */
int geomint_set(geomint *handle, size_t lane, const char *key, const char *value);
int geomint_slide(geomint *handle, size_t lane, const char *key, double position);
/* Restarts all lanes from a point of a phase plane or a section: at a pixel of the last picture, counted from its top
   left corner. Without effect elsewhere in the picture. It must have been drawn by GEOMINT_PAINTER=own. */
int geomint_point(geomint *handle, double across, double down);
/* Turns the camera of a picture in space by degrees, and multiplies its zoom. */
int geomint_look(geomint *handle, double azimuth, double elevation, double zoom);
/* Presses a key that has one meaning in the explorer: ".", ",", "B", "r", "tab", "c", "x", "o", "u", "PgUp", "PgDn",
   "Home" or "End". A key acts on the selected lane: "selected" of geomint_view. */
int geomint_press(geomint *handle, const char *key);

/* Return JSON, valid until the next text of the handle; NULL when out of memory, or for lanes that are not explored.
   The first is an object: the scene and its times, "lanes" (scheme, status, t, steps, evaluations, the values of the
   observables), "observables" (key, title, unit) and "parameters" (key, value, position, live, choices, help). The
   second is an array of the schemes that fit, as geomint_text describes one. */
const char *geomint_view(geomint *handle);
const char *geomint_schemes(geomint *handle);
/* The same for two command lines: "picture" draws the lanes as they are, "explorer" opens their present schemes and
   parameters from the start. */
const char *geomint_commands(geomint *handle);

/* ---- pictures ---- */

/* Chooses the colours of the pictures that follow: "light", as after opening, or "dark". */
int geomint_theme(geomint *handle, const char *name);
/* Draws all lanes in their current state into rgba: height rows of width * 4 bytes, the top row first; red,
   green, blue, and 255. Width and height are from 64 to 16384 pixels. A scene may show its past, so the first
   picture repeats the steps made so far in a copy of each lane. `scale` is the factor of letters and lines,
   from 1/4 to 4; 0 means 1. OSMesa paints if it can be loaded, or the painter that the environment variable
   GEOMINT_PAINTER names: auto, osmesa, egl or own. Fails with GEOMINT_USAGE if it names another painter or one
   that cannot be loaded, and with GEOMINT_FILE without a font; then the pixels may be anything. */
int geomint_draw(geomint *handle, int width, int height, double scale, unsigned char *rgba);
/* Writes the picture to a file whose name ends with .png, .svg or .pdf, with its command inside. Missing folders
   are made. Width, height and scale as above; in .svg and .pdf a pixel is 1/96 inch. A title of NULL is the
   scene's title; another one must not be empty or have control characters. */
int geomint_save(geomint *handle, const char *path, int width, int height, double scale, const char *title);

/* ---- exercises ---- */

/* Grades explored lanes as the answer to an exercise: step `step`, from 1, of a tour, by its name or the path of its
   file. Returns GEOMINT_OK if it is passed and GEOMINT_CLAIM if not; in both cases the message is the verdict. */
int geomint_grade(geomint *handle, const char *tour, size_t step);
/* Returns the answer as a text that `geomint grade` repeats: the tour's name, the words of the lanes, their steps and
   changes. It is valid until the next text of the handle; NULL on failure. */
const char *geomint_answer(geomint *handle, const char *tour, size_t step);

#ifdef __cplusplus
}
#endif

#endif
