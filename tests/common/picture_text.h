/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_PICTURE_TEXT_H
#define GM_TESTS_COMMON_PICTURE_TEXT_H

#include "render/picture/picture.h"

/* Writes the picture as text, one mark a line, numbers with 9 digits. */
void test_picture_write(const struct gm_picture *picture, FILE *stream);

#endif
