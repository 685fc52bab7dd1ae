/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_FONTS_H
#define GM_RENDER_DRAWING_FONTS_H

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H

#include "loader/library.h"

/* The functions of fontconfig, and of FreeType, which it needs itself: gm_fonts()->FT_New_Face(...). */
/* clang-format off */
#define GM_FONT_FUNCTIONS(F) \
    F(FT_Add_Default_Modules) F(FT_Done_Face) F(FT_Done_Library) F(FT_Get_Char_Index) F(FT_Load_Glyph) \
    F(FT_New_Face) F(FT_New_Library) F(FT_Outline_Translate) F(FT_Render_Glyph) F(FT_Set_Pixel_Sizes) \
    F(FcConfigDestroy) F(FcConfigSubstitute) F(FcDefaultSubstitute) F(FcFontMatch) \
    F(FcInitLoadConfigAndFonts) F(FcPatternAddBool) F(FcPatternAddInteger) F(FcPatternAddString) \
    F(FcPatternCreate) F(FcPatternDestroy) F(FcPatternGetString)
/* clang-format on */
GM_LIBRARY_TABLE(gm_fonts, GM_FONT_FUNCTIONS);

#endif
