/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_TEXT_H
#define GM_APP_BASE_TEXT_H

/* A text as printf writes it; malloc'ed, NULL when memory is short. */
__attribute__((format(printf, 1, 2))) char *gm_text(const char *format, ...);

#endif
