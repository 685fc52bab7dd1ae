/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_REQUEST_H
#define GM_APP_WORDS_REQUEST_H

#include "app/base/interrupt.h"
#include "render/message.h"
#include "scenes/common/lane.h"

struct gm_arena;
struct gm_arguments;

/* The user's request: a scene and its lanes, read from `SCENE key=value ...`. */

struct gm_lane_spec {
    struct gm_shown shown;
    void *parameters; /* the scene's own struct */
    struct gm_settings settings;
    const struct gm_scheme *scheme;
    int64_t steps; /* number of steps from start to until; the last one may be shortened */
    double until;  /* the requested end, in model time; NAN if steps= gives it */
    double end;    /* the time of the last step; for an adaptive scheme the end to reach */
};

/* The struct that holds a lane's value of a row, of its scene or of schemes. */
static inline void *gm_lane_owner(struct gm_lane_spec *spec, const struct gm_parameter *row)
{
    return gm_is_setting(row) ? &spec->settings : spec->parameters;
}

/* A change during a run: after `step` steps of lane `lane`, "key=value" (a live parameter or scheme). */
struct gm_change {
    size_t lane;
    int64_t step;
    char *text; /* the request's memory; a user-defined scheme is the word that reproduces it */
};

/* The largest number of steps of a lane, and of a change. */
#define GM_MOST_STEPS INT64_C(1000000000000000)

struct gm_request {
    const struct gm_scene *scene;
    struct gm_lane_spec *lanes;
    size_t count;
    struct gm_change *changes; /* sorted by step */
    size_t change_count;
    bool overlay;                  /* all lanes in one panel */
    int refusal;                   /* the exit status of a request that was refused; 0: wrong usage */
    char refused[48];              /* the key that was refused, or "" */
    const struct gm_scheme *unfit; /* the scheme that was refused, or NULL */
    size_t unfit_offset;           /* in its word, of what is lacking */
    char *arguments; /* the words it was read from, with the schemes' names; NULL: derived if needed */
};

/* Returns true if the last step of a run with this scheme is shortened to end at the requested until: one of
   fixed size for ordinary differential equations. */
bool gm_ends_exactly(const struct gm_scheme *scheme);

/* The number of a scene's preferred schemes that a command uses if no scheme is given. */
enum { GM_RUN_SCHEMES = 1, GM_RENDER_SCHEMES = 3 };

/* The scene of these words: the first one names it, or all of them define a system. Returns NULL with a
   sentence and an exit status. */
const struct gm_scene *gm_request_scene(int count, char *const words[], int *status, char *message);

/* Reads words such as "disc", "scheme=rk4,midpoint", "dt=pi/60,pi/12", "zip=yes", "overlay=yes" (the scene
   first). `schemes`: the number of preferred schemes if none is given. Returns false with one sentence in
   message (GM_MESSAGE bytes); the request is then empty, except `refusal`, `refused` and `unfit`. */
bool gm_request_parse(struct gm_request *request, int count, char *const words[], size_t schemes,
                      char *message);
/* The same for a scene that is known, and named by the first word; NULL: it is found. */
bool gm_request_parse_for(struct gm_request *request, const struct gm_scene *scene, int count,
                          char *const words[], size_t schemes, char *message);
/* The same for the stored arguments of an earlier request, in which a key may have no effect any more. A file with the name of
   that of the scene `shown` means this scene, whatever its folder; `shown` may be NULL. */
bool gm_request_recall(struct gm_request *request, const struct gm_scene *shown, const char *arguments,
                       char *message);
void gm_request_close(void *request);

/* Returns true if the runs of a comparison end together; else a sentence, as for steps= with several step
   sizes. */
bool gm_request_ends_together(const struct gm_request *request, char *message);

/* True if a key has an effect in a lane at the start. */
bool gm_request_uses(const struct gm_request *request, const char *key);

/* The exit status for a request that gm_request_parse refused. */
int gm_request_refusal(const struct gm_request *request);

/* The lanes as arguments that gm_request_parse reads to the same request: "disc scheme=rk4,midpoint ...",
   words separated by blanks, every parameter that is not at its default; malloc'ed. */
char *gm_request_format(const struct gm_request *request);

/* The changes as text, "lane step key=value" with this character for each blank and that one behind each, and back, a
   blank and a line each. */
char *gm_changes_format(const struct gm_request *request, char between, char end);
bool gm_changes_parse(struct gm_request *request, const char *text);

/* Sets the colour of lane number `lane`, and its panel, or the one for all lanes; names stay. */
void gm_show_in_order(struct gm_shown *shown, size_t lane, const struct gm_scheme *scheme, bool overlay);

/* Appends one change; returns false when out of memory. */
bool gm_change_add(struct gm_request *request, size_t lane, int64_t step, const char *text);
/* Removes the changes for which `drops` returns true; NULL: all. */
void gm_changes_drop(struct gm_request *request,
                     bool (*drops)(const struct gm_change *change, const void *data), const void *data);

/* Reads a value as gm_parameter_set does, without an owner to judge it alone; false with a sentence. */
bool gm_value_read(const struct gm_parameter *row, void *owner, const char *text, char *message);

/* A copy of a scene's parameters; malloc'ed. Returns NULL when out of memory. */
void *gm_parameters_copy(const struct gm_scene *scene, const void *parameters);

/* The number of steps of a lane; 0 for an adaptive scheme. */
double gm_request_steps(const struct gm_request *request, size_t index);

/* Opens lane `index` at its start; NULL with a sentence. */
struct gm_lane *gm_request_open_lane(const struct gm_request *request, size_t index, char *message);

/* Closes a lane with the arena, and returns it; NULL leaves the arena's body with this message. */
struct gm_lane *gm_lane_in(struct gm_arena *arena, struct gm_lane *lane, const char *message);

/* Returns true if a change can be made before its lane ends; false with a sentence. */
bool gm_change_check(const struct gm_request *request, const struct gm_change *change, char *message);

/* Makes the change "key=value" on a lane now (a live parameter or the scheme); false with a sentence. */
bool gm_change_apply(struct gm_lane *lane, const char *text, char *message);

/* A typed line without a shell: the words of a command line. A blank ends a key's word if another one,
   NAME=, follows it outside of parentheses. So a formula needs no quotes, H=p^2/2 - cos(q) q=2, and may
   have them. */

/* A fault of a line. */
struct gm_typed_fault {
    char sentence[GM_MESSAGE]; /* "": nothing */
    long at;                   /* the byte of the line; below 0: nowhere in it */
};

/* The words of a line, and the line of words, with quotes if they are needed, malloc'ed. Return false,
   NULL when out of memory. */
bool gm_typed_split(struct gm_arguments *words, const char *line);
char *gm_typed_join(const struct gm_arguments *words);

/* Reads a line of a system: a formula, H= L= rate=, a file or a name, with key=value; or of a scene with
   its keys. `schemes`: see gm_request_parse. Returns false with a fault. NULL: the line is only checked. */
bool gm_typed_request(struct gm_request *request, const char *line, size_t schemes,
                      struct gm_typed_fault *fault);
/* Returns true if the line can be read; stores nothing. */
bool gm_typed_check(const char *line, struct gm_typed_fault *fault);

/* The same for a scheme, a name, a path or a word, which goes to *kept; NULL: it is only checked. */
bool gm_typed_scheme(const char *line, const struct gm_scheme **kept, struct gm_typed_fault *fault);
/* Checks a scheme for a scene: before it in the line are the scene's words and a line end. */
bool gm_typed_check_scheme(const char *line, struct gm_typed_fault *fault);

#endif
