/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_EQUAL_COST_H
#define GM_APP_REQUEST_EQUAL_COST_H

#include "app/request/request.h"

/* Scales lane `index`'s dt so that it makes as many evaluations per model time as lane `like`, measured over
   some steps from its start, and names the step where the lane is named. False with a sentence (GM_MESSAGE
   bytes) if a scheme counts no evaluations or the step leaves its range. */
bool gm_equal_cost(struct gm_request *request, size_t index, size_t like, char *message);

#endif
