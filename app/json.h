/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_JSON_H
#define GM_APP_JSON_H

/* JSON on standard output. */

/* A string in quotes, escaped. */
void gm_json_text(const char *text);
/* "key":"text" */
void gm_json_pair(const char *key, const char *text);
/* 17 significant digits; null where it is no finite number. */
void gm_json_number(double value);

#endif
