/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_FONTS_H
#define GM_RENDER_GL_FONTS_H

#include <stdbool.h>

/* The file of the installed font nearest to a family; malloc'ed. NULL if no font is installed. */
char *gm_font_find(const char *family, bool bold);

#endif
