/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_STATUS_H
#define GM_CORE_STATUS_H

/* The status of a run. Any value but GM_OK is final: the run is frozen at its last good step. */
enum gm_status {
    GM_OK,
    GM_BLOW_UP,           /* a state that is not finite, or whose norm left the problem's bound */
    GM_NO_CONVERGENCE,    /* an implicit equation was not solved to round-off */
    GM_MESH_CROSSING,     /* a moving mesh would have tangled */
    GM_STEP_COLLAPSE,     /* an adaptive scheme found no step */
    GM_OUT_OF_MEMORY,     /* the system gave no memory: nothing is wrong with the numbers so far */
    GM_STEP_TOO_SMALL,    /* step size control led to round-off of the time, or to too many steps */
    GM_EVENTS_ACCUMULATE, /* events follow each other in ever shorter times */
    GM_SLIDING,           /* the rates on both sides of a break lead to it */
    GM_NO_TANGENT,        /* an event has no saltation matrix, which would lead tangents on */
    GM_STATUSES
};

/* The reason why an implicit equation was not solved. */
enum gm_obstacle {
    GM_NOT_KNOWN,
    GM_SINGULAR,    /* the matrix of Newton's method is singular */
    GM_NOT_FINITE,  /* a value of the iteration is not finite */
    GM_STILL_LARGE, /* the iteration still changes its unknowns */
    GM_STAYS_OFF,   /* no way back to the value of an invariant was found */
};
struct gm_unsolved {
    enum gm_obstacle obstacle;
    int invariant; /* the one that is farthest off, of those that the scheme holds */
    double change; /* the last one, relative to the state; or the invariant's distance, to its scale */
};

/* The name of a status as the command line prints it ("blow-up"). */
const char *gm_status_name(enum gm_status status);

#endif
