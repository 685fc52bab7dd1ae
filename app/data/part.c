/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file in the making: a folder beside it. */
#include "app/data/format.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "app/output/folder.h"
#include "render/message.h"

enum { NAME = 48 };
static const char identity[] = "identity";

struct gm_part {
    int folder; /* open, and locked as long as this process lives */
    char path[];
};

static void empty(const struct gm_part *part)
{
    DIR *entries = opendir(part->path);
    const struct dirent *entry = NULL;
    while (entries && (entry = readdir(entries))) {
        if (strncmp(entry->d_name, "lane-", strlen("lane-")) == 0) {
            unlinkat(part->folder, entry->d_name, 0);
        }
    }
    if (entries) {
        closedir(entries);
    }
    unlinkat(part->folder, identity, 0);
}

/* Opens the folder and takes the lock; returns false if its last holder has removed it meanwhile. */
static bool hold(struct gm_part *part, bool *held)
{
    struct stat mine, there;
    *held = false;
    part->folder = open(part->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (part->folder < 0) {
        return false;
    }
    if (flock(part->folder, LOCK_EX | LOCK_NB) != 0) {
        *held = errno == EWOULDBLOCK;
        return false;
    }
    errno = ENOENT;
    return fstat(part->folder, &mine) == 0 && stat(part->path, &there) == 0 && mine.st_ino == there.st_ino &&
           mine.st_dev == there.st_dev;
}

struct gm_part *gm_part_open(const char *path, bool go_on, char *message)
{
    const size_t size = strlen(path) + sizeof ".part";
    struct gm_part *part = malloc(sizeof *part + size);
    if (!part) {
        gm_refuse(message, "not enough memory");
        return NULL;
    }
    part->folder = -1;
    snprintf(part->path, size, "%s.part", path);
    bool held = false;
    const bool there = go_on || gm_folder_make(part->path, message);
    if (there && hold(part, &held)) {
        if (!go_on) {
            empty(part);
        }
        return part;
    }
    if (held) {
        gm_refuse(message, "%.300s is being written by another process", path);
    } else if (go_on && errno == ENOENT) {
        gm_refuse(message, "%.200s.part is missing: the saved run cannot be resumed", path);
    } else if (there) {
        gm_refuse(message, "%.300s.part could not be opened: %s", path, strerror(errno));
    }
    gm_part_close(part, false);
    return NULL;
}

void gm_part_close(struct gm_part *part, bool remove)
{
    if (remove) {
        empty(part);
        rmdir(part->path);
    }
    if (part->folder >= 0) {
        close(part->folder);
    }
    free(part);
}

bool gm_part_sign(struct gm_part *part)
{
    uint64_t number = 0;
    while (number == 0) {
        if (getrandom(&number, sizeof number, 0) != sizeof number && errno != EINTR) {
            return false;
        }
    }
    struct gm_bytes file =
        gm_bytes_of(openat(part->folder, identity, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    gm_bytes_write(&file, &number, sizeof number, 0);
    gm_bytes_sync(&file);
    return gm_bytes_close(&file);
}

uint64_t gm_part_identity(const struct gm_part *part)
{
    uint64_t number = 0;
    struct gm_bytes file = gm_bytes_of(openat(part->folder, identity, O_RDONLY | O_CLOEXEC));
    gm_bytes_read(&file, &number, sizeof number, 0);
    return gm_bytes_close(&file) ? number : 0;
}

static void name_of(char name[NAME], size_t lane, bool begun)
{
    snprintf(name, NAME, "lane-%zu%s", lane, begun ? ".new" : "");
}

int gm_part_file(const struct gm_part *part, size_t lane, bool begun)
{
    char name[NAME];
    name_of(name, lane, begun);
    return openat(part->folder, name, O_RDWR | O_CREAT | O_CLOEXEC | (begun ? O_TRUNC : 0), 0666);
}

bool gm_part_take(const struct gm_part *part, size_t lane)
{
    char begun[NAME], name[NAME];
    name_of(begun, lane, true);
    name_of(name, lane, false);
    return renameat(part->folder, begun, part->folder, name) == 0;
}

void gm_part_drop(const struct gm_part *part, size_t lane, bool begun)
{
    char name[NAME];
    name_of(name, lane, begun);
    unlinkat(part->folder, name, 0);
}

bool gm_part_publish(const struct gm_part *part, size_t lane, const char *path)
{
    char name[NAME];
    name_of(name, lane, false);
    return renameat(part->folder, name, AT_FDCWD, path) == 0;
}

uint64_t gm_part_capacity(const struct gm_part *part, uint64_t own)
{
    struct statvfs disk;
    struct rlimit limit;
    const uint64_t unknown = (uint64_t)1 << 40;
    uint64_t room =
        fstatvfs(part->folder, &disk) == 0 ? (uint64_t)disk.f_bavail * disk.f_frsize + own : unknown;
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < room) {
        room = limit.rlim_cur;
    }
    return room;
}
