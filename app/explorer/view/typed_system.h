/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_TYPED_SYSTEM_H
#define GM_APP_EXPLORER_VIEW_TYPED_SYSTEM_H

#include "app/explorer/surface/edit.h"
#include "app/words/typed.h"

/* The prompt for a system or a scheme of one's own, or a map of many runs: what is typed, and below it what
   is wrong, and where. */

enum gm_typed_kind {
    GM_TYPED_NONE,   /* the prompt is closed */
    GM_TYPED_SYSTEM, /* that takes the place of what is open */
    GM_TYPED_SWITCH, /* a scheme for the selected lane */
    GM_TYPED_FORK,   /* a scheme for one more lane from its state */
    GM_TYPED_MAP,    /* a sweep over two keys */
    GM_TYPED_KINDS
};

struct gm_typed_prompt {
    enum gm_typed_kind kind;
    struct gm_edit line;
    bool checked; /* the fault is that of the line as it is; else of an earlier one */
    struct gm_typed_fault fault;
    bool entered;               /* the line is to be taken once it is checked */
    char *last[GM_TYPED_KINDS]; /* what was typed before; NULL: nothing */
};

/* The rows that it takes of a screen of so many columns and rows; 0: it is closed. */
int gm_typed_prompt_rows(const struct gm_typed_prompt *prompt, int columns, int rows);
/* Fills the sheet, of so many rows. */
void gm_typed_prompt_draw(const struct gm_sheet *sheet, const struct gm_typed_prompt *prompt);
/* The keys, in the last row. */
void gm_typed_prompt_keys(const struct gm_sheet *last, const struct gm_typed_prompt *prompt);

#endif
