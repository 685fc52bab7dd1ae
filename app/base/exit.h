/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_EXIT_H
#define GM_APP_BASE_EXIT_H

/* Exit statuses of the program. */
enum {
    GM_EXIT_OK = 0,
    GM_EXIT_USAGE = 1,
    GM_EXIT_NUMERICAL = 2,
    GM_EXIT_FILE = 3,
    GM_EXIT_CLAIM = 4,
    GM_EXIT_MEMORY = 5,
    GM_EXIT_INTERRUPTED = 130,
    GM_EXIT_PIPE = 141,
};

#endif
