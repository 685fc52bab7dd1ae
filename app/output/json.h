/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_JSON_H
#define GM_APP_OUTPUT_JSON_H

#include <stdio.h>

/* JSON on standard output, or on a stream. */

/* A string in quotes, escaped; bytes that are no UTF-8 become U+FFFD. */
void gm_json_put_text(FILE *stream, const char *text);
/* "key":"text" */
void gm_json_pair(const char *key, const char *text);
/* "key":number, as gm_json_number writes it */
void gm_json_number_pair(const char *key, double value);
/* 17 significant digits; null where it is no finite number. */
void gm_json_number(double value);
void gm_json_put_number(FILE *stream, double value);

#endif
