/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that are written to a temporary name and renamed when they are complete. */
#include "render/files/temporary.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/message.h"

bool gm_temporary_fits(const char *path)
{
    struct stat status;
    return lstat(path, &status) != 0 || S_ISREG(status.st_mode);
}

bool gm_temporary_can_replace(const char *path, char *message)
{
    return gm_temporary_fits(path) || gm_refuse(message, "%.360s is not a file that can be replaced", path);
}

enum { NAME_SHOWN = 180 }; /* the name is cut, since it may already be as long as the file system allows */

/* The names in use; the thread that exchanges one owns it. */
enum { HELD = 64 };
static _Atomic(char *) held[HELD];

/* Stores the name, instead of one whose file does not exist: it was renamed, or never made. */
static void hold(const char *name)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    char *copy = strdup(name);
    size_t i = 0;
    pthread_mutex_lock(&lock);
    while (i < HELD && held[i] && access(held[i], F_OK) == 0) {
        i++;
    }
    free(i < HELD ? atomic_exchange(&held[i], copy) : copy);
    pthread_mutex_unlock(&lock);
}

void gm_temporary_remove_all(void)
{
    for (size_t i = 0; i < HELD; i++) {
        const char *name = atomic_exchange(&held[i], NULL);
        if (name) {
            unlink(name);
        }
    }
}

char *gm_temporary_name(const char *path, const char *ending)
{
    static atomic_uint counter;
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    int folder = (int)(name - path);
    char *temporary = NULL;
    /* a leading "./" prevents other programs from reading an option in "-a" or a protocol in "a:b" */
    if (asprintf(&temporary, "%s%.*s.%.*s.%ld.%u%s", path[0] == '/' ? "" : "./", folder, path, NAME_SHOWN,
                 name, (long)getpid(), atomic_fetch_add(&counter, 1), ending) < 0) {
        errno = ENOMEM;
        return NULL;
    }
    hold(temporary);
    return temporary;
}

bool gm_temporary_refuse(char *message, const char *path, const char *reason)
{
    const bool standard = strcmp(path, "/dev/stdout") == 0;
    return gm_refuse(message, "cannot write %.360s: %s", standard ? "standard output" : path, reason);
}

/* The contents of a file. */
struct contents {
    bool (*write)(FILE *file, const void *context);
    const void *context;
    bool synced; /* on the disk before the file gets its name */
};

/* Returns 0 or an errno. */
static int write_file(const char *path, const char *mode, const struct contents *contents)
{
    FILE *file = fopen(path, mode);
    if (!file) {
        return errno;
    }
    errno = 0;
    const bool written = contents->write(file, contents->context) && fflush(file) == 0 &&
                         (!contents->synced || fsync(fileno(file)) == 0);
    const int error = written ? 0 : errno ? errno : EIO;
    return fclose(file) != 0 && written ? errno : error;
}

static int replace(const char *path, const struct contents *contents)
{
    char *temporary = gm_temporary_name(path, ".tmp");
    int error = temporary ? write_file(temporary, "wbxe", contents) : ENOMEM;
    if (error == 0 && rename(temporary, path) != 0) {
        error = errno;
    }
    if (error != 0 && temporary) {
        unlink(temporary);
    }
    free(temporary);
    return error;
}

struct bytes {
    const void *at;
    size_t size;
};

static bool write_bytes(FILE *file, const void *context)
{
    const struct bytes *bytes = context;
    return fwrite(bytes->at, 1, bytes->size, file) == bytes->size;
}

int gm_temporary_write(const char *path, const void *bytes, size_t size)
{
    const struct contents contents = {.write = write_bytes, .context = &(struct bytes){bytes, size}};
    if (!gm_temporary_fits(path)) {
        return write_file(path, "wbe", &contents);
    }
    /* a signal that ends the process would leave a half file */
    sigset_t ends, unblocked;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &ends, &unblocked);
    const int error = replace(path, &contents);
    pthread_sigmask(SIG_SETMASK, &unblocked, NULL);
    return error;
}

bool gm_temporary_make(const char *path, bool (*write)(FILE *file, const void *context), const void *context)
{
    errno = replace(path, &(struct contents){.write = write, .context = context, .synced = true});
    return errno == 0;
}

bool gm_temporary_is_stale(const char *name)
{
    /* .NAME.PID.COUNTER.ENDING */
    const char *dots[3] = {NULL};
    for (const char *at = strchr(name, '.'); at; at = strchr(at + 1, '.')) {
        dots[0] = dots[1];
        dots[1] = dots[2];
        dots[2] = at;
    }
    long pid = 0;
    unsigned counter = 0;
    return name[0] == '.' && dots[0] > name && sscanf(dots[0], ".%ld.%u.", &pid, &counter) == 2 && pid > 0 &&
           kill((pid_t)pid, 0) != 0 && errno == ESRCH;
}

void gm_temporary_sweep(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    char *folder = slash ? strndup(path, (size_t)(name - path)) : strdup(".");
    DIR *entries = folder ? opendir(folder) : NULL;
    const size_t length = strnlen(name, NAME_SHOWN);
    const struct dirent *entry = NULL;
    while (entries && (entry = readdir(entries))) {
        const char *file = entry->d_name;
        if (file[0] == '.' && strncmp(file + 1, name, length) == 0 && file[1 + length] == '.' &&
            gm_temporary_is_stale(file)) {
            unlinkat(dirfd(entries), file, 0);
        }
    }
    if (entries) {
        closedir(entries);
    }
    free(folder);
}
