/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SCREEN_H
#define GM_APP_EXPLORER_SCREEN_H

#include "app/explorer/shot.h"
#include "render/cells.h"
#include "render/inline_image.h"

/* What is on the screen: the picture at the left, the side panel at the right, a status line below; or a page
   of help. All of it is composed as cells; nothing here knows the terminal. */

/* What the user has set about the screen itself. */
struct gm_face {
    enum gm_blocks blocks;
    enum gm_inline_kind pixels; /* the picture is not made of blocks */
    enum gm_theme theme;
    bool few_colours;
    bool help;
    int scroll;         /* lines of the help above the screen */
    bool choosing;      /* a scheme for the selected lane */
    size_t choice;      /* its number among the schemes that fit */
    size_t parameter;   /* the one that left and right change */
    bool explaining;    /* the status line says what that parameter is */
    unsigned long read; /* the last message that was seen and dismissed */
};

struct gm_screen {
    struct gm_cells cells;
    struct gm_cells picture; /* kept, as it changes less often than what is around it */
    bool fresh;              /* the kept picture shows the last shot */
    enum gm_blocks blocks;   /* and was painted with these */
    /* the upper left part of the screen that is left for a picture of pixels; no columns: none */
    int pixel_columns, pixel_rows;
};

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows);
void gm_screen_close(struct gm_screen *screen);

/* Composes the screen. `fresh` says that the shot's picture is a new one. */
void gm_screen_draw(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot, bool fresh);

/* The list of scenes, `choice` of them marked. */
void gm_screen_draw_start(struct gm_screen *screen, const struct gm_face *face, size_t choice);

/* ---- shared by the files that compose ---- */

/* A rectangle to write in. */
struct gm_sheet {
    struct gm_cells *cells;
    const struct gm_face *face;
    int column, row, width, height;
};

/* Writes in the sheet's own coordinates and stays in it; returns the cells that the text takes. */
int gm_sheet_text(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold);
/* The same, with the text's end at `column` (exclusive). */
void gm_sheet_right(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                    bool bold);
void gm_sheet_glyph(const struct gm_sheet *sheet, int column, int row, uint32_t glyph, enum gm_role role,
                    bool bold);
int gm_sheet_width(const struct gm_sheet *sheet, const char *text);

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);
void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);
void gm_help_draw(const struct gm_sheet *sheet, struct gm_face *face, const struct gm_shot *shot);

#endif
