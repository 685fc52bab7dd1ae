/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_CLOCK_H
#define GM_APP_REQUEST_CLOCK_H

/* Seconds since some moment in the past: of the wall, and of the processor in this thread. */
double gm_wall_seconds(void);
double gm_processor_seconds(void);

#endif
