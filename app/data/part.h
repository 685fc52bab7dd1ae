/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_PART_H
#define GM_APP_DATA_PART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a file is made of while it is made: a folder FILE.part beside it, which one process holds at a time,
   with a file a lane. */

struct gm_part;

/* Makes the folder, or with go_on takes it as an earlier process left it. NULL with a sentence (GM_MESSAGE
   bytes): it cannot be made, is not there to go on with, or another process holds it. */
struct gm_part *gm_part_open(const char *path, bool go_on, char *message);
/* Leaves the folder to be gone on with, or removes it. */
void gm_part_close(struct gm_part *part, bool remove);

/* Gives a folder that was just made a number of its own, on the disk when this returns: by it a checkpoint knows
   later that its rows are here, and not those of another run to the same file. False with errno. */
bool gm_part_sign(struct gm_part *part);
/* That number; 0: it has none. */
uint64_t gm_part_identity(const struct gm_part *part);

/* A lane's file, for reading and writing; or an empty one that is begun to be it, which it is once it is taken: the one
   before stays until then. -1 with errno. */
int gm_part_file(const struct gm_part *part, size_t lane, bool begun);
bool gm_part_take(const struct gm_part *part, size_t lane);
/* Removes what was begun, or the lane's file. */
void gm_part_drop(const struct gm_part *part, size_t lane, bool begun);
/* Renames a lane's file: it is now the file that was to be made. False with errno. */
bool gm_part_publish(const struct gm_part *part, size_t lane, const char *path);

/* How many bytes a file in the folder may have that has `own` bytes of the disk already: as the disk and the
   limits of the process are now. */
uint64_t gm_part_capacity(const struct gm_part *part, uint64_t own);

#endif
