/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which font file stands for a family on this machine. */
#include "render/gl/fonts.h"

#include <pthread.h>
#include <string.h>

#include <fontconfig/fontconfig.h>

static char *find_in(FcConfig *config, const char *family, bool bold)
{
    char *file = NULL;
    FcPattern *wanted = FcPatternCreate();
    if (wanted == NULL) {
        return NULL;
    }
    FcPatternAddString(wanted, FC_FAMILY, (const FcChar8 *)family);
    FcPatternAddInteger(wanted, FC_WEIGHT, bold ? FC_WEIGHT_BOLD : FC_WEIGHT_REGULAR);
    FcPatternAddInteger(wanted, FC_SLANT, FC_SLANT_ROMAN);
    FcPatternAddBool(wanted, FC_SCALABLE, FcTrue);
    FcConfigSubstitute(config, wanted, FcMatchPattern);
    FcDefaultSubstitute(wanted);
    FcResult result;
    FcPattern *found = FcFontMatch(config, wanted, &result);
    FcChar8 *name = NULL;
    if (found != NULL && FcPatternGetString(found, FC_FILE, 0, &name) == FcResultMatch) {
        file = strdup((const char *)name);
    }
    if (found != NULL) {
        FcPatternDestroy(found);
    }
    FcPatternDestroy(wanted);
    return file;
}

char *gm_font_find(const char *family, bool bold)
{
    /* FcFini ends what other threads may be using, so only one is inside at a time. */
    static pthread_mutex_t inside = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&inside);
    FcConfig *config = FcInitLoadConfigAndFonts();
    char *file = config != NULL ? find_in(config, family, bold) : NULL;
    if (config != NULL) {
        FcConfigDestroy(config);
    }
    FcFini();
    pthread_mutex_unlock(&inside);
    return file;
}
