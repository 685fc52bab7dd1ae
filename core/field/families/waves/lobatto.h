/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_WAVES_LOBATTO_H
#define GM_CORE_FIELD_FAMILIES_WAVES_LOBATTO_H

#include <stdbool.h>
#include <stddef.h>

/* A row of lobatto.c: what the scheme does in time. u and v = u_t make in turn
       v := v + kick_i dt f(u)      i = 0 .. kicks - 1
       u := u + drift_i dt v        behind each kick but the last
   or, with `collocated`, the three stages of Lobatto IIIA-IIIB, of which the kicks are the weights. */
enum { GM_LOBATTO_KICKS = 6 };
struct gm_lobatto_row {
    size_t kicks;
    double kick[GM_LOBATTO_KICKS], drift[GM_LOBATTO_KICKS - 1];
    bool collocated;
};

#endif
