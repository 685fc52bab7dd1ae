/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Letters, drawn by FreeType and stored in an atlas. */
#include "render/drawing/glyphs.h"

#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/cells/text.h"
#include "render/drawing/fonts.h"

GM_LIBRARY(gm_fonts, "libfontconfig.so.1", GM_FONT_FUNCTIONS)

/* Letters are hinted only vertically and placed at quarters of a pixel: stems keep their distances and
   horizontal strokes are sharp. Large letters need no such care. */
enum { SHIFTS = 4, LARGE = 48 };

enum { ATLAS_WIDTH = 1024, ATLAS_HIGHEST = 16384, BORDER = 1 };

struct glyph {
    bool used;
    uint64_t key;
    float advance;
    FT_UInt index;
    bool drawn;
    short x, y, width, height, atlas_x, atlas_y;
};

struct gm_glyphs {
    struct FT_MemoryRec_ memory; /* FreeType's allocator */
    bool refused;                /* true once memory was refused */
    FT_Library library;
    FT_Face faces[GM_FONT_COUNT];
    char *files[GM_FONT_COUNT];
    int sizes[GM_FONT_COUNT]; /* current heights, in pixels */
    struct glyph *table;      /* open addressing; the size is a power of two */
    size_t table_size, count;
    unsigned char *pixels;
    int atlas_height, changed;
    int shelf_x, shelf_y, shelf_height; /* the place of the next letter */
    struct glyph none;                  /* the letter when memory is short */
};

/* FreeType uses the program's allocators. A refusal is noted, since a letter may be missing from the picture,
   and FreeType may report something else, such as a missing module. */
static void *noted(FT_Memory memory, void *block)
{
    struct gm_glyphs *glyphs = memory->user;
    glyphs->refused = glyphs->refused || !block;
    return block;
}

static void *take(FT_Memory memory, long size)
{
    return noted(memory, malloc((size_t)size));
}

static void give_back(FT_Memory memory, void *block)
{
    (void)memory;
    free(block);
}

static void *take_more(FT_Memory memory, long before, long size, void *block)
{
    (void)before;
    return noted(memory, realloc(block, (size_t)size));
}

static bool start_library(struct gm_glyphs *glyphs)
{
    glyphs->memory =
        (struct FT_MemoryRec_){.user = glyphs, .alloc = take, .free = give_back, .realloc = take_more};
    if (gm_fonts()->FT_New_Library(&glyphs->memory, &glyphs->library) != 0) {
        return false;
    }
    gm_fonts()->FT_Add_Default_Modules(glyphs->library);
    if (glyphs->refused) {
        gm_fonts()->FT_Done_Library(glyphs->library);
    }
    return !glyphs->refused;
}

struct font_wanted {
    const char *family;
    bool bold;
};

static char *find_in(FcConfig *config, const char *family, bool bold)
{
    char *file = NULL;
    FcPattern *wanted = gm_fonts()->FcPatternCreate();
    if (!wanted) {
        return NULL;
    }
    gm_fonts()->FcPatternAddString(wanted, FC_FAMILY, (const FcChar8 *)family);
    gm_fonts()->FcPatternAddInteger(wanted, FC_WEIGHT, bold ? FC_WEIGHT_BOLD : FC_WEIGHT_REGULAR);
    gm_fonts()->FcPatternAddInteger(wanted, FC_SLANT, FC_SLANT_ROMAN);
    gm_fonts()->FcPatternAddBool(wanted, FC_SCALABLE, FcTrue);
    gm_fonts()->FcConfigSubstitute(config, wanted, FcMatchPattern);
    gm_fonts()->FcDefaultSubstitute(wanted);
    FcResult result;
    FcPattern *found = gm_fonts()->FcFontMatch(config, wanted, &result);
    FcChar8 *name = NULL;
    if (found && gm_fonts()->FcPatternGetString(found, FC_FILE, 0, &name) == FcResultMatch) {
        file = strdup((const char *)name);
    }
    if (found) {
        gm_fonts()->FcPatternDestroy(found);
    }
    gm_fonts()->FcPatternDestroy(wanted);
    return file;
}

/* Finds the installed fonts nearest to the wanted ones. The caller frees files[]; NULL if none is installed,
   or, with errno ENOMEM, when out of memory. */
static void find_fonts(const struct font_wanted wanted[GM_FONT_COUNT], char *files[GM_FONT_COUNT])
{
    /* a separate configuration, since others may use the global one; it is read once for all fonts, since
       reading takes longer than matching */
    errno = 0;
    FcConfig *config = gm_fonts()->FcInitLoadConfigAndFonts();
    for (int i = 0; config && i < GM_FONT_COUNT; i++) {
        files[i] = find_in(config, wanted[i].family, wanted[i].bold);
    }
    if (config) {
        const int error = errno;
        gm_fonts()->FcConfigDestroy(config);
        errno = error;
    }
}

/* Returns false if there is no memory for a file: FreeType calls one that it cannot read one of an unknown format. */
static bool has_space(const char *file)
{
    struct stat about;
    void *block = stat(file, &about) == 0 ? malloc((size_t)about.st_size + 1) : NULL;
    free(block);
    return block != NULL || errno != ENOMEM;
}

struct gm_glyphs *gm_glyphs_open(char *message, size_t size)
{
    static const struct font_wanted wanted[GM_FONT_COUNT] = {
        [GM_FONT_SANS] = {"DejaVu Sans", false},
        [GM_FONT_BOLD] = {"DejaVu Sans", true},
        [GM_FONT_MONO] = {"DejaVu Sans Mono", false},
        [GM_FONT_MONO_BOLD] = {"DejaVu Sans Mono", true},
    };
    struct gm_glyphs *glyphs = calloc(1, sizeof *glyphs);
    if (!glyphs || !start_library(glyphs)) {
        snprintf(message, size, "There is not enough memory for text.");
        free(glyphs);
        errno = ENOMEM;
        return NULL;
    }
    find_fonts(wanted, glyphs->files);
    const bool short_of_memory = errno == ENOMEM;
    for (int i = 0; i < GM_FONT_COUNT; i++) {
        const char *file = glyphs->files[i];
        const bool missing = !file && !short_of_memory;
        FT_Error error = file ? gm_fonts()->FT_New_Face(glyphs->library, file, 0, &glyphs->faces[i])
                              : FT_Err_Out_Of_Memory;
        if (error != 0 && file && !has_space(file)) {
            error = FT_Err_Out_Of_Memory;
        }
        if (missing) {
            snprintf(message, size, "No font was found for \"%s\"; install the package fonts-dejavu-core.",
                     wanted[i].family);
        } else if (error == FT_Err_Out_Of_Memory || (error != 0 && glyphs->refused)) {
            snprintf(message, size, "There is not enough memory for text.");
        } else if (error != 0) {
            snprintf(message, size, "The font for \"%s\" could not be read (FreeType's error %d).",
                     wanted[i].family, error);
        }
        if (error != 0) {
            const bool refused = error == FT_Err_Out_Of_Memory || glyphs->refused;
            gm_glyphs_close(glyphs);
            errno = missing ? ENOENT : refused ? ENOMEM : EIO;
            return NULL;
        }
    }
    return glyphs;
}

void gm_glyphs_close(struct gm_glyphs *glyphs)
{
    if (!glyphs) {
        return;
    }
    for (int i = 0; i < GM_FONT_COUNT; i++) {
        gm_fonts()->FT_Done_Face(glyphs->faces[i]);
        free(glyphs->files[i]);
    }
    gm_fonts()->FT_Done_Library(glyphs->library);
    free(glyphs->table);
    free(glyphs->pixels);
    free(glyphs);
}

static FT_Face face_of(struct gm_glyphs *glyphs, enum gm_font font, int height)
{
    if (glyphs->sizes[font] != height) {
        gm_fonts()->FT_Set_Pixel_Sizes(glyphs->faces[font], 0, (FT_UInt)height);
    }
    glyphs->sizes[font] = height;
    return glyphs->faces[font];
}

static struct glyph *slot_of(struct glyph *table, size_t size, uint64_t key)
{
    size_t place = (size_t)(key * UINT64_C(0x9e3779b97f4a7c15) >> 32) & (size - 1);
    while (table[place].used && table[place].key != key) {
        place = (place + 1) & (size - 1);
    }
    return &table[place];
}

static bool table_grow(struct gm_glyphs *glyphs)
{
    const size_t size = glyphs->table_size > 0 ? 2 * glyphs->table_size : 512;
    struct glyph *table = calloc(size, sizeof *table);
    if (!table) {
        return false;
    }
    for (size_t i = 0; i < glyphs->table_size; i++) {
        if (glyphs->table[i].used) {
            *slot_of(table, size, glyphs->table[i].key) = glyphs->table[i];
        }
    }
    free(glyphs->table);
    glyphs->table = table;
    glyphs->table_size = size;
    return true;
}

static _Atomic uint32_t lacking[GM_LACKING]; /* code points; 0: free */

static void note_lacking(uint32_t code)
{
    for (size_t i = 0; i < GM_LACKING; i++) {
        uint32_t there = 0;
        if (atomic_compare_exchange_strong(&lacking[i], &there, code) || there == code) {
            return;
        }
    }
}

size_t gm_glyphs_lacking(uint32_t letters[GM_LACKING])
{
    size_t count = 0;
    while (count < GM_LACKING && (letters[count] = lacking[count]) != 0) {
        count++;
    }
    return count;
}

/* Returns the entry of a letter; the advance is set, the image perhaps not yet. */
static struct glyph *glyph_of(struct gm_glyphs *glyphs, enum gm_font font, int height, uint32_t code,
                              int shift)
{
    const uint64_t key = (uint64_t)code << 32 | (uint64_t)height << 8 | (uint64_t)shift << 4 | (uint64_t)font;
    if (2 * glyphs->count >= glyphs->table_size && !table_grow(glyphs)) {
        return &glyphs->none;
    }
    struct glyph *glyph = slot_of(glyphs->table, glyphs->table_size, key);
    if (glyph->used) {
        return glyph;
    }
    const FT_Face face = face_of(glyphs, font, height);
    *glyph = (struct glyph){.used = true, .key = key, .index = gm_fonts()->FT_Get_Char_Index(face, code)};
    glyphs->count++;
    if (glyph->index == 0) {
        note_lacking(code);
    }
    if (gm_fonts()->FT_Load_Glyph(face, glyph->index, FT_LOAD_TARGET_LIGHT) == 0) {
        glyph->advance = (float)face->glyph->linearHoriAdvance / 65536.0f;
    }
    return glyph;
}

/* Finds room on the atlas's shelves, which are as high as their highest letter. Returns false without
   room. */
static bool atlas_place(struct gm_glyphs *glyphs, int width, int height, short *x, short *y)
{
    if (width + BORDER > ATLAS_WIDTH) {
        return false;
    }
    if (glyphs->shelf_x + width + BORDER > ATLAS_WIDTH) {
        glyphs->shelf_y += glyphs->shelf_height;
        glyphs->shelf_x = glyphs->shelf_height = 0;
    }
    const int bottom = glyphs->shelf_y + height + BORDER;
    if (bottom > glyphs->atlas_height) {
        int taller = glyphs->atlas_height > 0 ? glyphs->atlas_height : 256;
        while (taller < bottom) {
            taller *= 2;
        }
        unsigned char *pixels =
            taller > ATLAS_HIGHEST ? NULL : realloc(glyphs->pixels, (size_t)taller * ATLAS_WIDTH);
        if (!pixels) {
            return false;
        }
        memset(pixels + (size_t)glyphs->atlas_height * ATLAS_WIDTH, 0,
               (size_t)(taller - glyphs->atlas_height) * ATLAS_WIDTH);
        glyphs->pixels = pixels;
        glyphs->atlas_height = taller;
        glyphs->changed = 0;
    }
    *x = (short)glyphs->shelf_x;
    *y = (short)glyphs->shelf_y;
    glyphs->shelf_x += width + BORDER;
    if (glyphs->shelf_height < height + BORDER) {
        glyphs->shelf_height = height + BORDER;
    }
    return true;
}

static void glyph_draw(struct gm_glyphs *glyphs, struct glyph *glyph, enum gm_font font, int height,
                       int shift)
{
    glyph->drawn = true;
    const FT_Face face = face_of(glyphs, font, height);
    if (gm_fonts()->FT_Load_Glyph(face, glyph->index, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP) != 0) {
        return;
    }
    gm_fonts()->FT_Outline_Translate(&face->glyph->outline, shift * 64 / SHIFTS, 0);
    if (gm_fonts()->FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) != 0) {
        return;
    }
    const FT_Bitmap *bitmap = &face->glyph->bitmap;
    const int columns = (int)bitmap->width, rows = (int)bitmap->rows;
    if (!atlas_place(glyphs, columns, rows, &glyph->atlas_x, &glyph->atlas_y)) {
        return;
    }
    for (int row = 0; row < rows; row++) {
        memcpy(glyphs->pixels + (size_t)(glyph->atlas_y + row) * ATLAS_WIDTH + glyph->atlas_x,
               bitmap->buffer + row * bitmap->pitch, (size_t)columns);
    }
    if (glyphs->changed > glyph->atlas_y) {
        glyphs->changed = glyph->atlas_y;
    }
    glyph->x = (short)face->glyph->bitmap_left;
    glyph->y = (short)-face->glyph->bitmap_top;
    glyph->width = (short)columns;
    glyph->height = (short)rows;
}

double gm_glyphs_width(struct gm_glyphs *glyphs, enum gm_font font, int height, const char *text)
{
    double width = 0.0;
    for (uint32_t code; (code = gm_text_next(&text)) != 0;) {
        width += glyph_of(glyphs, font, height, code, 0)->advance;
    }
    return width;
}

double gm_glyphs_ascent(struct gm_glyphs *glyphs, enum gm_font font, int height)
{
    const FT_Face face = glyphs->faces[font];
    return (double)height * face->ascender / face->units_per_EM;
}

double gm_glyphs_descent(struct gm_glyphs *glyphs, enum gm_font font, int height)
{
    const FT_Face face = glyphs->faces[font];
    return -(double)height * face->descender / face->units_per_EM;
}

const char *gm_glyphs_family(const struct gm_glyphs *glyphs, enum gm_font font)
{
    return glyphs->faces[font]->family_name;
}

const char *gm_glyphs_file(const struct gm_glyphs *glyphs, enum gm_font font)
{
    return glyphs->files[font];
}

bool gm_glyphs_next(struct gm_glyphs *glyphs, enum gm_font font, int height, const char **text, double *pen,
                    struct gm_letter *letter)
{
    const uint32_t code = gm_text_next(text);
    if (code == 0) {
        return false;
    }
    double whole = floor(*pen);
    int shift = height >= LARGE ? 0 : (int)((*pen - whole) * SHIFTS + 0.5);
    if (shift == SHIFTS) {
        shift = 0;
        whole += 1.0;
    }
    struct glyph *glyph = glyph_of(glyphs, font, height, code, shift);
    if (!glyph->drawn) {
        glyph_draw(glyphs, glyph, font, height, shift);
    }
    *letter = (struct gm_letter){.x = (int)whole + glyph->x,
                                 .y = glyph->y,
                                 .width = glyph->width,
                                 .height = glyph->height,
                                 .atlas_x = glyph->atlas_x,
                                 .atlas_y = glyph->atlas_y};
    *pen += glyph->advance;
    return true;
}

struct gm_atlas gm_glyphs_atlas(struct gm_glyphs *glyphs)
{
    const struct gm_atlas atlas = {.pixels = glyphs->pixels,
                                   .width = ATLAS_WIDTH,
                                   .height = glyphs->atlas_height,
                                   .changed = glyphs->changed,
                                   .used = glyphs->shelf_y + glyphs->shelf_height};
    glyphs->changed = glyphs->atlas_height;
    return atlas;
}
