/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_TOURS_TOUR_H
#define GM_APP_TOURS_TOUR_H

#include "app/grid/grid.h"
#include "app/runs/session.h"
#include "app/words/request.h"
#include "core/expression/reader.h"
#include "render/layout/appearance.h"

/* A tour: steps for a class, read from a text file that a teacher can write (docs/tours.md). Texts of one
   paragraph are without line breaks. */

enum { GM_EVERY_LANE = -1 };

/* A change during the run, at a model time. */
struct gm_tour_change {
    double t;
    long lane;  /* a lane's number from 0, or GM_EVERY_LANE */
    char *text; /* "scheme=midpoint", "dt=0.1" */
    char *line; /* the whole line after "at:" */
};

/* A condition that a lane must meet at the end of an exercise. */
enum { GM_MOST_NAMES = 16 };
struct gm_expectation {
    char *text; /* "energy_error < 1e-6" */
    struct gm_formula graph;
    gm_node_id node; /* 1 if it is met, else 0 */
    size_t names
        [GM_MOST_NAMES]; /* numbers of names; variable i of the graph is the value of the name names[i] */
    const char *keys[GM_MOST_NAMES]; /* the names as they are written */
    size_t count;
};

struct gm_tour_step {
    char *title;
    char *say;    /* the subject of the step */
    char *ask;    /* a question to answer before it runs, or the task of an exercise; NULL: none */
    char *answer; /* the answer to the question; of an exercise shown when it is passed */
    char *hint;   /* a hint for an exercise, or NULL */
    struct gm_expectation *expectations;
    size_t expectation_count; /* 0: the step is not an exercise */
    char *watch;              /* a hint for watching, or NULL */
    char *attempt;            /* a suggestion to try, or NULL */
    char *show; /* the arguments of `request`; NULL: the step continues from the end of the one before */
    struct gm_request request;
    double until;                   /* model time to run to */
    double seconds;                 /* time for watching the run */
    struct gm_tour_change *changes; /* sorted by time */
    size_t change_count;
    enum gm_study_kind study;
    char *study_words; /* the words of the study's command, the scene first; NULL: no study */
};

struct gm_tour {
    struct gm_arena *arena; /* owns the following */
    char *name;             /* the file's name, without folder and ending */
    char *path;             /* of its file; NULL: the program has it inside, or it was read from memory */
    char *title;
    char *about; /* one line for the list */
    long place;  /* position in the list */
    struct gm_tour_step *steps;
    size_t count; /* number of steps, at least 1 */
};

/* Reads a tour and tries out everything that it shows. Returns false with one sentence that names file and
   line (GM_MESSAGE bytes); the tour is then empty. */
struct gm_file;
bool gm_tour_read(struct gm_tour *tour, const struct gm_file *file, char *message);
/* The same from memory; `name` stands for the file in sentences, and paths of schemes are from its folder. */
bool gm_tour_parse(struct gm_tour *tour, const char *name, const char *text, size_t size, char *message);
void gm_tour_close(void *tour);

/* The step that shows the scene on which this one builds. */
size_t gm_tour_first(const struct gm_tour *tour, size_t step);
/* The model time at which a step's display begins. */
double gm_tour_begin(const struct gm_tour *tour, size_t step);

/* ---- exercises ---- */

/* Reads a condition on the lanes of a scene. Returns false with a fault. Everything is the arena's. */
bool gm_expectation_read(struct gm_arena *arena, const struct gm_scene *scene, char *text,
                         struct gm_expectation *expectation, struct gm_fault *fault);

/* Returns false with a sentence (GM_MESSAGE bytes) if the step shows another scene than this one. */
bool gm_exercise_is_about(const struct gm_tour_step *step, const struct gm_scene *scene, char *message);

/* Returns true if a lane of this request, whose scene is the step's, passes the exercise as it is now: it has reached
   the step's end, meets all expectations, and differs from what the step shows in schemes, the step size, the view and
   named parameters alone. The sentence (GM_MESSAGE bytes) gives the reason. */
bool gm_exercise_passed(const struct gm_tour_step *step, const struct gm_request *request,
                        const struct gm_lane *const *lanes, char *sentence);

/* An answer to an exercise is text of at most this size: what was done, which can be repeated. */
enum { GM_MOST_ANSWER = 2048 };
/* Writes the answer; malloc'ed. Returns NULL when out of memory. */
char *gm_answer_write(const struct gm_tour *tour, size_t step, const struct gm_request *request,
                      const struct gm_lane *const *lanes);
/* Repeats an answer and grades it, with the tour that a word means (NULL: the answer's own). Returns the exit status:
   GM_EXIT_OK if it is passed, GM_EXIT_CLAIM if not, with the tour and the step in `exercise` (GM_MESSAGE bytes); another one
   if it cannot be repeated; always with a sentence (GM_MESSAGE bytes). */
int gm_answer_grade(const char *text, size_t size, const char *tour, char *exercise, char *sentence);

/* ---- the places of tours ---- */

/* The file of the tour that a word means: a path, a name, or a title. Returns false with a sentence;
   *unreadable: a folder or a tour could not be read. */
bool gm_tour_find(const char *word, struct gm_file *file, bool *unreadable, char *message);

/* The readable tours in their order; sets *count. An unreadable tour is left out; message has the sentence
   of the first one, or of a folder that cannot be opened, and is otherwise empty. malloc'ed; free with
   gm_tours_close. */
struct gm_tour *gm_tours_read(size_t *count, char *message);
void gm_tours_close(struct gm_tour *tours, size_t count);

/* The plan of a tour's step for a session: changes during the run, and the stop. Without a tour it is
   empty. */
struct gm_agenda {
    const struct gm_tour *tour; /* NULL: none; outlives the agenda */
    size_t step;
    size_t at_step, at_change; /* the next change */
    bool over;                 /* the stop was reached; the user continues freely */
};

/* The agenda of a step for a session that begins at the start of step `from` <= step. */
struct gm_agenda gm_agenda_of(const struct gm_tour *tour, size_t step, size_t from);

/* The model time that a session must not pass before gm_agenda_keep; infinite without one. */
double gm_agenda_limit(const struct gm_agenda *agenda);

/* Makes the changes that are due. True when the stop has just been reached. A change that cannot be made is
   left out, with a sentence in message (GM_MESSAGE bytes, else empty). */
bool gm_agenda_keep(struct gm_agenda *agenda, struct gm_session *session, char *message);

/* Notes that the session went back to the time t: later changes are due again. */
void gm_agenda_rewind(struct gm_agenda *agenda, double t);

/* The output of a tour without a screen, with its texts: a movie, or pictures, one for every question and
   one for the end of every step. */
struct gm_tour_output {
    const char *movie;  /* the file; NULL: pictures */
    const char *folder; /* the pictures' folder, made if it is missing; NULL: the current one */
    double fps;         /* frames per second of the movie */
    struct gm_appearance look;
};

/* Returns the exit status. */
int gm_tour_render(const struct gm_tour *tour, const struct gm_tour_output *output);

#endif
