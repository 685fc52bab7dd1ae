/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_LANE_H
#define GM_TESTS_COMMON_LANE_H

#include "scenes/common/lane.h"

/* Lanes for tests, as the command line would make them. */

/* The first lane of "SCENE key=value ..."; ends the test with a message if it cannot be opened. */
struct gm_lane *test_lane(const char *arguments);

/* The value of an observable now, by its key. */
double test_observed(const struct gm_lane *lane, const char *key);

#endif
