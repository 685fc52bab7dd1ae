/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_REFERENCE_VERSION_H
#define GM_APP_COMMANDS_REFERENCE_VERSION_H

/* --version: the program and the libraries. Returns the exit status. */
int gm_version(void);

#endif
