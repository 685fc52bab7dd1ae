/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_RUNS_SHOT_H
#define GM_APP_RUNS_SHOT_H

#include "app/runs/session.h"
#include "app/runs/slider.h"

/* A finished look at a session: everything the screen shows, as a copy. The thread that steps fills one while
   the screen shows another, so neither waits for the other. */

enum {
    GM_SHOT_OBSERVABLES = 24,
    GM_SHOT_PARAMETERS = 48,
    GM_SHOT_SCHEMES = GM_FITTING_SCHEMES,
    GM_SPARK = 16, /* places of a tiny graph */
};

/* The command lines of a view: as a picture, and the explorer with these lanes from their start. */
enum { GM_COMMAND_PICTURE, GM_COMMAND_EXPLORER, GM_COMMANDS };

struct gm_spark {
    double low[GM_SPARK], high[GM_SPARK]; /* low > high where there is nothing */
};

struct gm_shot_lane {
    struct gm_shown shown; /* named as at its start */
    const struct gm_scheme *scheme, *first_scheme;
    enum gm_status status;
    long lost; /* the observable that tells of it, gm_lane_lost; -1: nothing, or the lane has failed */
    double t;
    double from_start; /* largest difference from the start's components */
    double values[GM_SHOT_OBSERVABLES];
    struct gm_spark sparks[GM_SHOT_OBSERVABLES];
};

struct gm_shot_parameter {
    const struct gm_parameter *row;
    bool of_scheme;
    bool differs;    /* from lane to lane; the value is the selected one's */
    double position; /* 0 to 1 in its range, or -1 */
    char value[GM_TEXT_SIZE];
};

struct gm_shot {
    const struct gm_scene *scene;
    struct gm_picture *picture;
    size_t lane_count, selected;
    struct gm_shot_lane lanes[GM_MOST_LANES];
    size_t observable_count;
    size_t parameter_count;
    struct gm_shot_parameter parameters[GM_SHOT_PARAMETERS];
    size_t scheme_count;
    const struct gm_scheme *schemes[GM_SHOT_SCHEMES]; /* all that fit, */
    const struct gm_scheme *same[GM_SHOT_SCHEMES];    /* and others whose steps are the same here; or NULL */
    double t, speed;
    double cost;        /* seconds that it took to take it */
    double pace;        /* steps of the selected lane per second at that speed */
    double ahead;       /* where to run ahead is of use */
    double gone, reach; /* model time gone through, and up to the last snapshot */
    bool backwards;     /* time runs */
    bool turned;        /* or has run */
    bool overlaid;      /* all lanes are in one panel */
    bool in_space;      /* the picture can be gone around */
    bool drawn;         /* the picture is a new one */
    bool running_ahead; /* nothing is drawn meanwhile */
    double progress;    /* of that, 0 to 1 */
    bool paused;
    bool behind; /* the steps cost more than the speed allows */
    char message[GM_MESSAGE];
    unsigned long message_number; /* changes with every message */
    double recorded;              /* seconds of the movie so far; below 0: none is made */
    char *commands[GM_COMMANDS];  /* that redo a view; NULL: memory was short */
    unsigned long command_number; /* changes with every one */
};

bool gm_shot_open(struct gm_shot *shot);
void gm_shot_close(struct gm_shot *shot);

/* Fills in what comes from the session; looks only. The picture is drawn, or left as it was. */
void gm_shot_take(struct gm_shot *shot, const struct gm_session *session, size_t selected, bool draw);

/* Whether a lane has the scheme. */
bool gm_shot_uses(const struct gm_shot *shot, const struct gm_scheme *scheme);

#endif
