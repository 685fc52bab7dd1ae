/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_BACKWARD_H
#define GM_APP_STUDIES_BACKWARD_H

#include "app/base/arguments.h"
#include "app/grid/listener.h"
#include "app/words/request.h"
#include "core/ode/backward/modified_energy.h"

/* Backward error: how well a scheme keeps its modified Hamiltonian, by the power of dt after which that is
   cut off, and by dt. */

enum { GM_BACKWARD_POWERS = GM_MODIFIED_POWER + 1 };

struct gm_backward_point { /* one run */
    double dt, t;          /* the time it came to */
    enum gm_status status;
    bool tried;
    /* Cut off after dt^k: the largest |H~(y_n) - H~(y_0)| of so many looks at the run, and of the terms the
       largest |dt^k H_k|, both divided by what the energy error is divided by. NAN: the scheme has none. */
    double errors[GM_BACKWARD_POWERS], terms[GM_BACKWARD_POWERS];
    int best; /* the k with the smallest error */
    /* If terms go on as k! (dt / gamma)^k, as the last two of those known do: they are smallest at k = gamma
       / dt, and what is left drifts by exp(-gamma / 2 dt) in the time exp(gamma / 2 dt). Hairer, Lubich &
       Wanner (2006), IX.8. NAN where fewer than two are known. */
    double gamma;
};

struct gm_backward_line { /* of one scheme, by falling dt */
    const struct gm_scheme *scheme;
    struct gm_backward_point *points;
    size_t count;
    char why[GM_MODIFIED_WHY]; /* why there is no modified Hamiltonian; "" where there is */
    double orders
        [GM_BACKWARD_POWERS]; /* the slopes at the two smallest steps whose errors are above round-off; NAN */
    bool shown[GM_BACKWARD_POWERS]; /* H, and the powers of which a term does not vanish */
};

struct gm_backward_table {
    struct gm_request request; /* a lane for every run */
    struct gm_backward_line *lines;
    size_t count;
};

/* Reads the words, a scene and its key=value, of which scheme and dt may be lists. False with a sentence
   (GM_MESSAGE bytes); of the table only request.refusal says something then. */
bool gm_backward_open(struct gm_backward_table *table, const struct gm_arguments *arguments, char *message);
void gm_backward_close(struct gm_backward_table *table);

/* Makes the runs; stopped, the others stay untried. False with a sentence: memory, or no scheme has what is
   asked. */
bool gm_backward_measure(struct gm_backward_table *table, const struct gm_listener *listener, char *message);

/* Writes a row of CSV for every run and power. False, with errno, if that fails. */
bool gm_backward_write(const struct gm_backward_table *table, const char *path);

void gm_backward_draw(const struct gm_backward_table *table, struct gm_picture *picture);

#endif
