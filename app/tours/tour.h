/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_TOURS_TOUR_H
#define GM_APP_TOURS_TOUR_H

#include "app/grid/grid.h"
#include "app/runs/session.h"
#include "app/words/request.h"
#include "render/layout/appearance.h"

/* A tour: steps for a class, read from a text file that a teacher can write (docs/tours.md). Texts of one
   paragraph are without line breaks. */

enum { GM_EVERY_LANE = -1 };

/* A change during the run, at a model time. */
struct gm_tour_change {
    double t;
    long lane;  /* a lane's number from 0, or GM_EVERY_LANE */
    char *text; /* "scheme=midpoint", "dt=0.1" */
};

struct gm_tour_step {
    char *title;
    char *say;     /* the subject of the step */
    char *ask;     /* a question to answer before it runs; NULL: none */
    char *answer;  /* the answer to the question */
    char *watch;   /* a hint for watching, or NULL */
    char *attempt; /* a suggestion to try, or NULL */
    char *show;    /* the arguments of `request`; NULL: the step continues from the end of the one before */
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
