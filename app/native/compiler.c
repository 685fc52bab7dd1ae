/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The compiler's process: found, started, watched, ended. */
#include "app/native/cache.h"

#include <ctype.h>
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "render/cells/text.h"
#include "render/clock.h"
#include "render/message.h"

enum { MOST_BYTES = 1 << 24, MOST_COMPLAINTS = 1 << 20, COULD_NOT_START = 127, LONGEST = 12 };

/* The limit of CPU time, and of clock time without it, in seconds; the limit of all clock time is LONGEST
   times that. */
static double most_seconds(void)
{
    const char *own = getenv("GEOMINT_COMPILER_SECONDS");
    const double seconds = own ? strtod(own, NULL) : 0;
    return seconds >= 1 && seconds <= 3600 ? seconds : 10;
}

bool gm_program_find(const char *name, char path[GM_CACHE_PATH], struct stat *about)
{
    const char *folders = getenv("PATH");
    for (const char *at = folders ? folders : ""; *at; at += *at == ':') {
        const size_t length = strcspn(at, ":");
        if (length > 0 && *at == '/' &&
            snprintf(path, GM_CACHE_PATH, "%.*s/%s", (int)length, at, name) < GM_CACHE_PATH &&
            stat(path, about) == 0 && S_ISREG(about->st_mode) && access(path, X_OK) == 0) {
            return true;
        }
        at += length;
    }
    return false;
}

bool gm_compiler_find(char path[GM_CACHE_PATH], struct gm_digest *digest)
{
    struct stat about;
    if (!gm_program_find("cc", path, &about) && !gm_program_find("gcc", path, &about) &&
        !gm_program_find("clang", path, &about)) {
        return false;
    }
    gm_digest_add(digest, path, strlen(path) + 1);
    gm_digest_add(digest, &about.st_ino, sizeof about.st_ino);
    gm_digest_add(digest, &about.st_size, sizeof about.st_size);
    gm_digest_add(digest, &about.st_mtim, sizeof about.st_mtim);
    return true;
}

/* PATH of its environment: the absolute folders of ours, for the programs that it starts itself. */
static void put_search_path(char *path, size_t size)
{
    const char *folders = getenv("PATH");
    size_t end = (size_t)snprintf(path, size, "PATH=");
    for (const char *at = folders ? folders : ""; *at; at += *at == ':') {
        const size_t length = strcspn(at, ":");
        if (*at == '/' && end + length + 2 < size) {
            end += (size_t)snprintf(path + end, size - end, "%s%.*s", path[end - 1] == '=' ? "" : ":",
                                    (int)length, at);
        }
        at += length;
    }
}

static void limit(int resource, rlim_t most, rlim_t utmost)
{
    const struct rlimit limits = {most, utmost};
    setrlimit(resource, &limits);
}

/* Runs in the child, which must not allocate memory. */
__attribute__((noreturn)) static void become(const char *const *arguments, char *const *environment,
                                             int folder, int log, rlim_t seconds)
{
    sigset_t none;
    const int nothing = open("/dev/null", O_RDWR);
    setpgid(0, 0);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGXCPU, SIG_DFL);
    limit(RLIMIT_CPU, seconds, seconds + 1); /* the first limit's signal gives the reason */
    limit(RLIMIT_FSIZE, MOST_BYTES, MOST_BYTES);
    limit(RLIMIT_CORE, 0, 0);
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC); /* files that libraries have opened */
    if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(nothing, STDOUT_FILENO) >= 0 &&
        dup2(log, STDERR_FILENO) >= 0 && fchdir(folder) == 0) {
        execve(arguments[0], (char *const *)arguments, environment);
    }
    _exit(COULD_NOT_START);
}

/* Moves a file above the numbers of standard streams, which the child replaces: if those are closed it may
   have one. */
static int above_streams(int file)
{
    if (file < 0 || file > STDERR_FILENO) {
        return file;
    }
    const int other = fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    close(file);
    return other;
}

bool gm_compilation_start(struct gm_compilation *compilation, const char *folder,
                          const char *const *arguments, char *sentence)
{
    char path[2 * GM_CACHE_PATH], aside[GM_CACHE_PATH + 8];
    put_search_path(path, sizeof path);
    snprintf(aside, sizeof aside, "TMPDIR=%s", folder);
    char language[] = "LC_ALL=C", *const environment[] = {path, aside, language, NULL};
    const int where = above_streams(open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    const int complaints = above_streams(memfd_create("complaints", MFD_CLOEXEC));
    const rlim_t seconds = (rlim_t)most_seconds();
    pid_t child = -1;
    if (where >= 0 && complaints >= 0) {
        child = fork();
        if (child == 0) {
            become(arguments, environment, where, complaints, seconds);
        }
    }
    const int error = errno;
    if (where >= 0) {
        close(where);
    }
    if (child < 0) {
        if (complaints >= 0) {
            close(complaints);
        }
        return gm_refuse(sentence, "the compiler could not be started: %s", strerror(error));
    }
    setpgid(child, child); /* the faster of the two sets it */
    *compilation = (struct gm_compilation){
        .process = child, .complaints = complaints, .begin = gm_clock_seconds(), .seen = gm_clock_seconds()};
    return true;
}

/* Reads the group and the CPU time, in ticks, of a process and its ended children from a line of
   /proc/PID/stat. Returns false for any other line. */
static bool read_stat(const char *text, pid_t *group, unsigned long *ticks)
{
    const char *name_end = strrchr(text, ')'); /* a name may hold anything */
    unsigned long times[4] = {0};
    const int read = name_end
                         ? sscanf(name_end, ") %*c %*d %d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu %lu %lu",
                                  group, &times[0], &times[1], &times[2], &times[3])
                         : 0;
    *ticks = times[0] + times[1] + times[2] + times[3];
    return read == 5;
}

/* The CPU time of all processes of a group, in ticks; 0 if it is unavailable. */
static unsigned long ticks_of(pid_t group)
{
    unsigned long all = 0, ticks;
    DIR *processes = opendir("/proc");
    for (const struct dirent *process; processes && (process = readdir(processes));) {
        char path[300], text[1024];
        pid_t its = 0;
        snprintf(path, sizeof path, "/proc/%s/stat", process->d_name);
        const int file = isdigit((unsigned char)process->d_name[0]) ? open(path, O_RDONLY | O_CLOEXEC) : -1;
        if (file < 0) {
            continue;
        }
        const ssize_t length = read(file, text, sizeof text - 1);
        close(file);
        text[length > 0 ? length : 0] = '\0';
        all += read_stat(text, &its, &ticks) && its == group ? ticks : 0;
    }
    if (processes) {
        closedir(processes);
    }
    return all;
}

static bool complains_without_end(const struct gm_compilation *compilation)
{
    struct stat complaints;
    return fstat(compilation->complaints, &complaints) == 0 && complaints.st_size > MOST_COMPLAINTS;
}

/* The first line that it complained with is the reason. */
static void refuse_with_complaints(const struct gm_compilation *compilation, char *sentence)
{
    char line[200];
    const ssize_t length = pread(compilation->complaints, line, sizeof line - 1, 0);
    line[length > 0 ? length : 0] = '\0';
    line[strcspn(line, "\n")] = '\0';
    gm_text_tame(line);
    gm_refuse(sentence, "the compiler %s%s%s",
              complains_without_end(compilation) ? "complained without end" : "failed", line[0] ? ": " : "",
              line);
}

/* Returns true, with a sentence, if the compilation must be ended. Waiting for a processor on a busy
   machine is allowed. The system's limit counts each process alone; here all child processes count. */
static bool is_overdue(struct gm_compilation *compilation, char *sentence)
{
    const double now = gm_clock_seconds(), most = most_seconds();
    if (complains_without_end(compilation)) {
        refuse_with_complaints(compilation, sentence);
        return true;
    }
    if (now < compilation->seen + most) {
        return false;
    }
    const unsigned long ticks = ticks_of(compilation->process), before = compilation->ticks;
    compilation->seen = now;
    compilation->ticks = ticks;
    if ((double)ticks > most * (double)sysconf(_SC_CLK_TCK)) {
        return !gm_refuse(sentence, "the compiler took more than %.0f seconds of a processor", most);
    }
    if (now > compilation->begin + LONGEST * most) {
        return !gm_refuse(sentence, "the compiler took longer than %.0f seconds", LONGEST * most);
    }
    return ticks == before && !gm_refuse(sentence, "the compiler hung for %.0f seconds", most);
}

enum gm_compiled gm_compilation_look(struct gm_compilation *compilation, char *sentence)
{
    int status = 0;
    struct rusage used = {0};
    const pid_t ended = wait4(compilation->process, &status, WNOHANG, &used);
    if (ended == 0 || (ended < 0 && errno == EINTR)) {
        if (!is_overdue(compilation, sentence)) {
            return GM_COMPILES;
        }
        gm_compilation_stop(compilation);
        return GM_COMPILES_NOT;
    }
    compilation->process = 0;
    const bool compiled = ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    /* ended by its limit's signal, or by a process that ended its children; the limit's clock counts whole
       ticks, too many on a busy machine, so that it differs from the measured time */
    const bool limited = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
    const double seconds = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    if (!compiled && ended > 0 && (limited || seconds >= 0.9 * most_seconds())) {
        gm_refuse(sentence, "the compiler took more than %.0f seconds of a processor", most_seconds());
    } else if (!compiled) {
        refuse_with_complaints(compilation, sentence);
    }
    close(compilation->complaints);
    return compiled ? GM_COMPILED : GM_COMPILES_NOT;
}

void gm_compilation_stop(struct gm_compilation *compilation)
{
    if (compilation->process > 0) {
        /* it is asked to end first, since compilers then remove their temporary files */
        enum { LOOKS = 100 };
        siginfo_t ended = {0};
        kill(-compilation->process, SIGTERM);
        for (int look = 0; look < LOOKS && ended.si_pid == 0; look++) {
            nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
            waitid(P_PID, (id_t)compilation->process, &ended, WEXITED | WNOHANG | WNOWAIT);
        }
        kill(-compilation->process, SIGKILL);
        kill(compilation->process, SIGKILL);
        while (waitpid(compilation->process, NULL, 0) < 0 && errno == EINTR) {
        }
        compilation->process = 0;
        close(compilation->complaints);
    }
}

/* bin/geomint, lib/libgeomint.so or lib/MACHINE/libgeomint.so, whichever contains this function, beside share/geomint,
   wherever they have been moved together. */
static bool beside_program(char *path, size_t size)
{
    static const char part = 0;
    Dl_info here;
    const bool library = dladdr(&part, &here) && strstr(here.dli_fname, "libgeomint.so");
    char *self = realpath(library ? here.dli_fname : "/proc/self/exe", NULL);
    char *slash = self ? strrchr(self, '/') : NULL;
    bool found = false;
    for (int up = 0; slash && up < 3 && !found; up++) {
        *slash = '\0';
        const int wanted = snprintf(path, size, "%s/share/geomint/kernel", self);
        found = up > 0 && wanted < (int)size && access(path, R_OK) == 0;
        slash = strrchr(self, '/');
    }
    free(self);
    return found;
}

const char *gm_kernel_folder(char *path, size_t size)
{
    const char *own = getenv("GEOMINT_KERNEL");
    if (own && *own) {
        snprintf(path, size, "%s", own);
    } else if (!beside_program(path, size)) {
        snprintf(path, size, "%s", GM_KERNEL_FOLDER);
    }
    return path;
}
