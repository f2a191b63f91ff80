/* stickslip-mumps: factors of bodies by MUMPS, on the ranks of one MPI job. stickslip starts it, as `mpirun -n N stickslip-mumps FOLDER`.
 *
 * Rank 0 reads commands, a line each, from its standard input and answers each by a line on its standard output. Numbers go through files in
 * FOLDER, whose format words.c knows. Who reads a file
 * deletes it. What a body is known by, ID, is a small number that stickslip chooses.
 *
 *   factor ID N C OUT-OF-CORE LOW-RANK MEGABYTES SPREAD CELLS FILE
 *                               rank r reads FILE.r, its share of the lower triangle of a matrix of N rows, of which the last C are kept, and if CELLS is 1 makes the
 *                               matrices of the cells in FILE.cells.r besides; what is in several shares is added up. The Schur complement goes to FILE.schur, by columns from the diagonal, or stays with the ranks if SPREAD is 1
 *   reduce ID COLUMNS FILE      forces, N a column -> FILE.out, what is left of them at the kept rows, C a column
 *   expand ID COLUMNS 0 FILE    displacements of the kept rows for the forces reduced last -> FILE.out.r, those of the others that rank r has: their
 *                               count, their rows, the columns
 *   expand ID COLUMNS 1 FILE    the same for forces that come first in the file, N - C a column
 *   multiply ID COLUMNS FILE    vectors, C a column -> FILE.out, products with the Schur complement that is spread, or with its inverse
 *   invert ID COLUMNS SIGMA FILE  adds SIGMA times the products of these vectors with themselves to it, and inverts it
 *   free ID
 *   quit
 *
 * Answers: `ready PROTOCOL VERSION RANKS` at first, then `ok NUMBERS...` or `error INFOG(1) INFOG(2) WHAT`. What cannot go on ends all ranks. So does the end of the
 * input without `quit` (stickslip is gone: FOLDER is removed), or that of the parent of any rank (mpirun is gone).
 */
#include "shared.h"
#include <dirent.h>
#include <dlfcn.h>
#include <ftw.h>
#include <glob.h>
#include <pthread.h>
#include <stdarg.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#define PROTOCOL 3
#define BODIES 256
#define USE_COMM_WORLD -987654
/* Times that a factorisation which asked for more work space is tried again with twice as much. */
#define TRIES 6

enum { QUIT, FACTOR, REDUCE, EXPAND, MULTIPLY, INVERT, FREE };

/* A command, as all ranks get it. */
typedef struct {
    int what, id, columns, fresh, out_of_core, megabytes, spread, cells;
    int64_t n, kept;
    double low_rank, sigma;
    char file[64];
} Command;

static DMUMPS_STRUC_C *bodies[BODIES];
/* Their Schur complements, where they are spread. */
static Grid *grids[BODIES];
static pid_t parent;
/* Lines of the standard input on their way from the thread that waits for them. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t came = PTHREAD_COND_INITIALIZER;
static char line[512];
static int has_line, quitting;

static void doze(long *nanoseconds) {
    struct timespec pause = {0, *nanoseconds};
    nanosleep(&pause, NULL);
    if (*nanoseconds < 1000000) *nanoseconds += *nanoseconds / 4;
}

/* Nobody is left to work for: takes the folder with what is in it along. */
static void remove_folder(void) {
    char path[4096];
    struct dirent *entry;
    DIR *open = opendir(folder);
    while (open && (entry = readdir(open))) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] != '.') unlink(path);
    }
    if (open) closedir(open);
    rmdir(folder);
}

static int remove_one(const char *path, const struct stat *unused, int kind, struct FTW *place) {
    (void)unused, (void)kind, (void)place;
    remove(path);
    return 0;
}

/* Files of Open MPI that mpirun would have removed, had it not been killed. */
static void remove_session(void) {
    const char *session = getenv("OMPI_MCA_orte_jobfam_session_dir"), *job = getenv("PMIX_NAMESPACE");
    char pattern[256];
    glob_t found;
    if (session) nftw(session, remove_one, 16, FTW_DEPTH | FTW_PHYS);
    if (!job) return;
    snprintf(pattern, sizeof pattern, "/dev/shm/vader_segment.*.%lx.*", strtoul(job, NULL, 10));
    if (glob(pattern, 0, NULL, &found)) return;
    for (size_t i = 0; i < found.gl_pathc; i++) unlink(found.gl_pathv[i]);
    globfree(&found);
}

/* Ends this rank when what started it is gone: MPI would have it wait for ever. */
static void *watch_parent(void *unused) {
    struct timespec pause = {0, 200000000};
    (void)unused;
    while (getppid() == parent) nanosleep(&pause, NULL);
    remove_session();
    _exit(1);
    return NULL;
}

static void *read_lines(void *unused) {
    char text[sizeof line];
    (void)unused;
    while (fgets(text, sizeof text, stdin)) {
        pthread_mutex_lock(&lock);
        while (has_line) pthread_cond_wait(&came, &lock);
        memcpy(line, text, sizeof line);
        has_line = 1;
        quitting |= !strncmp(text, "quit", 4);
        pthread_cond_broadcast(&came);
        pthread_mutex_unlock(&lock);
    }
    if (!quitting) {
        remove_folder();
        if (getppid() != parent) remove_session();
        _exit(1);
    }
    return NULL;
}

/* The next command on all ranks. Who waits for one sleeps: between two, stickslip works, maybe on the same processors. */
static Command next_command(void) {
    Command c;
    MPI_Request request;
    char what[16];
    int done = 0;
    long pause = 20000;
    memset(&c, 0, sizeof c);
    if (rank == 0) {
        pthread_mutex_lock(&lock);
        while (!has_line) pthread_cond_wait(&came, &lock);
        if (sscanf(line, "factor %d %" SCNd64 " %" SCNd64 " %d %lf %d %d %d %63s", &c.id, &c.n, &c.kept, &c.out_of_core, &c.low_rank, &c.megabytes,
                   &c.spread, &c.cells, c.file) == 9)
            c.what = FACTOR;
        else if (sscanf(line, "reduce %d %d %63s", &c.id, &c.columns, c.file) == 3)
            c.what = REDUCE;
        else if (sscanf(line, "expand %d %d %d %63s", &c.id, &c.columns, &c.fresh, c.file) == 4)
            c.what = EXPAND;
        else if (sscanf(line, "multiply %d %d %63s", &c.id, &c.columns, c.file) == 3)
            c.what = MULTIPLY;
        else if (sscanf(line, "invert %d %d %lf %63s", &c.id, &c.columns, &c.sigma, c.file) == 4)
            c.what = INVERT;
        else if (sscanf(line, "free %d", &c.id) == 1)
            c.what = FREE;
        else if (sscanf(line, "%15s", what) != 1 || strcmp(what, "quit"))
            die("what is `%s`?", line);
        has_line = 0;
        pthread_cond_broadcast(&came);
        pthread_mutex_unlock(&lock);
        if (c.id < 0 || c.id >= BODIES || c.n < 0 || c.n > INT32_MAX || c.kept < 0 || c.kept > c.n) die("wrong numbers in a command");
        if ((c.what == REDUCE || c.what == EXPAND) && (!bodies[c.id] || c.columns < 1)) die("body %d has no factor", c.id);
        if ((c.what == MULTIPLY || c.what == INVERT) && (!grids[c.id] || c.columns < 0)) die("body %d has nothing that is spread", c.id);
        if (c.what == FACTOR && bodies[c.id]) die("body %d has a factor already", c.id);
    }
    MPI_Ibcast(&c, sizeof c, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); !done; MPI_Test(&request, &done, MPI_STATUS_IGNORE)) doze(&pause);
    return c;
}

static void job(DMUMPS_STRUC_C *body, int number) {
    body->job = number;
    dmumps_c(body);
}

static void drop(int id) {
    DMUMPS_STRUC_C *body = bodies[id];
    if (!body) return;
    job(body, -2);
    free_matrix(body);
    free(body->listvar_schur);
    free(body->rhs);
    free(body->redrhs);
    if (!grids[id]) free(body->schur);
    drop_grid(grids[id]);
    free(body);
    bodies[id] = NULL;
    grids[id] = NULL;
}

static DMUMPS_STRUC_C *new_body(const Command *c) {
    DMUMPS_STRUC_C *body = get(1, sizeof *body);
    body->sym = 1; /* positive definite */
    body->par = 1; /* rank 0 works, too */
    body->comm_fortran = USE_COMM_WORLD;
    job(body, -1);
    if (body->INFOG(1) < 0) return body;
    for (int i = 1; i <= 3; i++) body->ICNTL(i) = -1;
    body->ICNTL(4) = 0;
    body->ICNTL(7) = 5;  /* METIS */
    body->ICNTL(18) = 3; /* the matrix is given by ranks */
    body->ICNTL(22) = c->out_of_core;
    body->ICNTL(23) = c->megabytes;
    if (c->low_rank > 0) {
        body->ICNTL(35) = 2;
        body->CNTL(7) = c->low_rank;
    }
    snprintf(body->ooc_tmpdir, sizeof body->ooc_tmpdir, "%s", folder);
    body->n = (MUMPS_INT)c->n;
    return body;
}

/* What is left of the matrix at the kept rows: on all ranks, or all of it on rank 0, its lower triangle by columns: a grid of one. */
static void keep_schur(DMUMPS_STRUC_C *body, const Command *c) {
    body->size_schur = (MUMPS_INT)c->kept;
    if (!c->kept) return;
    body->listvar_schur = get(c->kept, sizeof *body->listvar_schur);
    for (int64_t i = 0; i < c->kept; i++) body->listvar_schur[i] = (MUMPS_INT)(c->n - c->kept + i + 1);
    if (c->spread) {
        grids[c->id] = plan_grid(body);
        return;
    }
    body->ICNTL(19) = 2;
    body->nprow = body->npcol = 1;
    body->mblock = body->nblock = 64;
}

static void write_schur(DMUMPS_STRUC_C *body, const Command *c) {
    size_t n = c->kept;
    if (rank == 0) {
        Words to = write_to(c->file, ".schur", -1, n * (n + 1) / 2);
        for (size_t j = 0; j < n; j++) write_words(&to, body->schur + j * n + j, n - j);
        end_writing(&to);
    }
    free(body->schur);
    body->schur = NULL;
}

static void complain(const DMUMPS_STRUC_C *body, const char *during) { answer("error %d %d %s", body->INFOG(1), body->INFOG(2), during); }

static int wants_more_space(int info) { return info == -8 || info == -9 || info == -14 || info == -15 || info == -17 || info == -20; }

static void factor(const Command *c) {
    DMUMPS_STRUC_C *body = bodies[c->id] = new_body(c);
    if (body->INFOG(1) < 0) {
        complain(body, "start");
        return drop(c->id);
    }
    read_matrix(body, c->file);
    int64_t wrong = c->cells ? make_cells(body, c->file) : 0;
    if (wrong) {
        answer("error 1 %" PRId64 " assembly", wrong - 1);
        return drop(c->id);
    }
    keep_schur(body, c);
    job(body, 1);
    if (body->INFOG(1) < 0) {
        complain(body, "analysis");
        return drop(c->id);
    }
    if (grids[c->id]) make_room(grids[c->id], body);
    else if (rank == 0 && c->kept) {
        body->schur_lld = (MUMPS_INT)c->kept;
        body->schur = get((size_t)c->kept * c->kept, 8);
    }
    for (int tried = 0; tried < TRIES; tried++) {
        job(body, 2);
        if (!wants_more_space(body->INFOG(1)) || c->megabytes) break;
        body->ICNTL(14) = 2 * body->ICNTL(14) + 20;
    }
    if (body->INFOG(1) < 0 || body->INFOG(12) > 0) {
        if (body->INFOG(1) >= 0) answer("error -10 %d negative pivots", body->INFOG(12));
        else complain(body, "factorisation");
        return drop(c->id);
    }
    free_matrix(body);
    if (!grids[c->id]) write_schur(body, c);
    double stiff = grids[c->id] ? trace(grids[c->id]) : 0;
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    int64_t own = usage.ru_maxrss, most = 0, sum = 0;
    MPI_Reduce(&own, &most, 1, MPI_INT64_T, MPI_MAX, 0, MPI_COMM_WORLD);
    MPI_Reduce(&own, &sum, 1, MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
    double entries = body->INFOG(29) < 0 ? -1e6 * body->INFOG(29) : body->INFOG(29);
    answer("ok %" PRId64 " %" PRId64 " %.0f %.0f %.17g", most, sum, body->RINFOG(3), entries, stiff);
}

/* Room for vectors on rank 0. */
static void room(DMUMPS_STRUC_C *body, int columns) {
    if (rank == 0 && (!body->rhs || columns != body->nrhs)) {
        free(body->rhs);
        free(body->redrhs);
        body->rhs = get((size_t)body->n * columns, 8);
        body->redrhs = get((size_t)body->size_schur * columns, 8);
    }
    body->nrhs = columns;
    body->lrhs = body->n;
    body->lredrhs = body->size_schur;
}

static int solve(DMUMPS_STRUC_C *body, int way) {
    body->ICNTL(26) = way;
    body->ICNTL(21) = way != 1; /* solutions stay with the ranks */
    job(body, 3);
    if (body->INFOG(1) >= 0) return 1;
    complain(body, "solution");
    return 0;
}

/* A solution as it comes: this rank writes what it has of it. */
static int expand(DMUMPS_STRUC_C *body, const Command *c) {
    size_t count = body->lsol_loc = body->INFO(23), columns = c->columns;
    body->isol_loc = get(count + 1, sizeof *body->isol_loc);
    body->sol_loc = get(count * columns + 1, 8);
    /* Without kept rows there is nothing to reduce, and the expansion is the whole solution. */
    int ok = solve(body, body->size_schur ? 2 : 0);
    if (ok) {
        Words to = write_to(c->file, ".out", rank, 1 + count * (1 + columns));
        uint64_t word = count;
        write_words(&to, &word, 1);
        for (size_t i = 0; i < count; i++) {
            word = (uint64_t)body->isol_loc[i] - 1;
            write_words(&to, &word, 1);
        }
        write_words(&to, body->sol_loc, count * columns);
        end_writing(&to);
    }
    free(body->isol_loc);
    free(body->sol_loc);
    body->isol_loc = NULL;
    body->sol_loc = NULL;
    /* Nobody reads before all have written. */
    MPI_Barrier(MPI_COMM_WORLD);
    return ok;
}

static void solve_for(const Command *c) {
    DMUMPS_STRUC_C *body = bodies[c->id];
    size_t n = body->n, kept = body->size_schur, columns = c->columns;
    int ok = 1, forces = c->what == REDUCE || c->fresh;
    Words from;
    room(body, c->columns);
    if (rank == 0) {
        size_t rows = c->what == REDUCE ? n : n - kept;
        from = read_from(c->file, -1, columns * (forces ? rows : 0) + columns * (c->what == EXPAND ? kept : 0));
        for (size_t k = 0; forces && k < columns; k++) {
            read_words(&from, body->rhs + k * n, rows);
            if (rows < n) memset(body->rhs + k * n + rows, 0, 8 * kept);
        }
    }
    if (forces && kept) ok = solve(body, 1);
    if (rank == 0) {
        if (c->what == EXPAND) read_words(&from, body->redrhs, columns * kept);
        end_reading(&from);
    }
    if (ok && c->what == EXPAND) ok = expand(body, c);
    if (!ok) return;
    if (rank == 0 && c->what == REDUCE) {
        Words to = write_to(c->file, ".out", -1, columns * kept);
        write_words(&to, body->redrhs, columns * kept);
        end_writing(&to);
    }
    answer("ok");
}

/* What is done with a Schur complement that is spread. */
static void dense(const Command *c) {
    int row = 0;
    if (c->what == MULTIPLY) multiply(grids[c->id], c->columns, c->file);
    else row = invert(grids[c->id], c->columns, c->sigma, c->file);
    if (row) answer("error -10 %d inverse", row);
    else answer("ok");
}

/* OpenBLAS takes room for its work with the first product, 128 MB of addresses, and keeps it; where there is none it asks for ever. So a product comes before
 * MUMPS takes what there is. Nothing is linked for it: whatever BLAS MUMPS brings along is asked. */
static void make_room_for_products(void) {
    typedef void Product(const char *, const char *, const MUMPS_INT *, const MUMPS_INT *, const MUMPS_INT *, const double *, const double *,
                         const MUMPS_INT *, const double *, const MUMPS_INT *, const double *, double *, const MUMPS_INT *, size_t, size_t);
    /* Large enough to be no small product, of which some processors make short work without room. */
    const MUMPS_INT n = 128;
    const double one = 1;
    Product *multiply = (Product *)dlsym(RTLD_DEFAULT, "dgemm_");
    double *numbers = get(3 * (size_t)n * n, 8);
    void *there = malloc((size_t)160 << 20);
    if (!there) die("no memory for products of matrices");
    free(there);
    if (multiply) multiply("N", "N", &n, &n, &n, &one, numbers, &n, numbers + n * n, &n, &one, numbers + 2 * n * n, &n, 1, 1);
    free(numbers);
}

int main(int count, char **arguments) {
    int level;
    pthread_t thread;
    if (count != 2) {
        fprintf(stderr, "usage: stickslip-mumps FOLDER; stickslip starts it\n");
        return 1;
    }
    folder = arguments[1];
    parent = getppid();
    pthread_create(&thread, NULL, watch_parent, NULL);
    MPI_Init_thread(&count, &arguments, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (access(folder, R_OK | W_OK)) die("%s is not there; set STICKSLIP_MUMPS_DIR to a folder that all machines see", folder);
    make_room_for_products();
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0 && pthread_create(&thread, NULL, read_lines, NULL)) die("no thread");
    answer("ready %d %s %d", PROTOCOL, MUMPS_VERSION, ranks);
    for (Command c = next_command(); c.what != QUIT; c = next_command()) {
        if (c.what == FACTOR) factor(&c);
        if (c.what == FREE) drop(c.id);
        if (c.what == FREE) answer("ok");
        if (c.what == REDUCE || c.what == EXPAND) solve_for(&c);
        if (c.what == MULTIPLY || c.what == INVERT) dense(&c);
    }
    for (int id = 0; id < BODIES; id++) drop(id);
    MPI_Finalize();
    return 0;
}
