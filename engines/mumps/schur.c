/* The Schur complement where it is too large for one process: block-cyclic over a grid of all ranks, as MUMPS leaves it (ICNTL(19) = 2) and ScaLAPACK takes it.
 * Of the lower triangle each rank has some rows of some columns. A product sends the vectors to all ranks, and adds what comes of them. */
#include "shared.h"

#define BLOCK 64

/* Of ScaLAPACK, which has no header. */
void Cblacs_get(int context, int what, int *value);
void Cblacs_gridinit(int *context, const char *order, int rows, int columns);
void Cblacs_gridexit(int context);
void descinit_(int *descriptor, const int *m, const int *n, const int *mb, const int *nb, const int *row, const int *column, const int *context,
               const int *lld, int *info);
void pdpotrf_(const char *triangle, const int *n, double *a, const int *i, const int *j, const int *descriptor, int *info);
void pdpotri_(const char *triangle, const int *n, double *a, const int *i, const int *j, const int *descriptor, int *info);

struct Grid {
    int n, rows, columns, row, column; /* of the matrix; of the grid; where this rank is in it */
    int own_rows, own_columns, lld;
    double *values;
};

Grid *plan_grid(DMUMPS_STRUC_C *body) {
    Grid *grid = get(1, sizeof *grid);
    grid->n = body->size_schur;
    for (grid->rows = 1; (grid->rows + 1) * (grid->rows + 1) <= ranks;) grid->rows++;
    while (ranks % grid->rows) grid->rows--;
    grid->columns = ranks / grid->rows;
    grid->row = rank / grid->columns;
    grid->column = rank % grid->columns;
    body->ICNTL(19) = 2;
    body->nprow = grid->rows;
    body->npcol = grid->columns;
    body->mblock = body->nblock = BLOCK;
    return grid;
}

void make_room(Grid *grid, DMUMPS_STRUC_C *body) {
    grid->own_rows = body->schur_mloc;
    grid->own_columns = body->schur_nloc;
    grid->lld = grid->own_rows > 1 ? grid->own_rows : 1;
    grid->values = get((size_t)grid->lld * (grid->own_columns > 1 ? grid->own_columns : 1), 8);
    body->schur_lld = grid->lld;
    body->schur = grid->values;
}

void drop_grid(Grid *grid) {
    if (!grid) return;
    free(grid->values);
    free(grid);
}

/* The row or column of the matrix that an own one is. */
static int whole(int own, int at, int of) { return (own / BLOCK * of + at) * BLOCK + own % BLOCK; }

/* The first own row that is not above a row of the matrix. */
static int first_row(const Grid *grid, int below) {
    int cycle = grid->rows * BLOCK, own = below / cycle * BLOCK, rest = below % cycle - grid->row * BLOCK;
    own += rest < 0 ? 0 : rest > BLOCK ? BLOCK : rest;
    return own < grid->own_rows ? own : grid->own_rows;
}

double trace(const Grid *grid) {
    double own = 0, all = 0;
    for (int j = 0; j < grid->own_columns; j++) {
        int column = whole(j, grid->column, grid->columns), i = first_row(grid, column);
        if (i < grid->own_rows && whole(i, grid->row, grid->rows) == column) own += grid->values[(size_t)j * grid->lld + i];
    }
    MPI_Reduce(&own, &all, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    return all;
}

/* Vectors of a file, on all ranks. */
static double *vectors(const Grid *grid, int columns, const char *file) {
    double *x = get((size_t)grid->n * (columns > 0 ? columns : 1), 8);
    if (rank == 0) {
        Words from = read_from(file, -1, (size_t)grid->n * columns);
        read_words(&from, x, (size_t)grid->n * columns);
        end_reading(&from);
    }
    for (int k = 0; k < columns; k++) MPI_Bcast(x + (size_t)k * grid->n, grid->n, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    return x;
}

/* Some of the entries of a vector: those of own rows. */
static double *own_part(const Grid *grid, const double *x, double *own) {
    for (int i = 0; i < grid->own_rows; i++) own[i] = x[whole(i, grid->row, grid->rows)];
    return own;
}

void multiply(const Grid *grid, int columns, const char *file) {
    size_t n = grid->n, m = grid->own_rows;
    double *x = vectors(grid, columns, file), *y = get(n * columns, 8), *own_x = get(m * columns + 1, 8), *own_y = get(m * columns + 1, 8);
    for (int k = 0; k < columns; k++) own_part(grid, x + k * n, own_x + k * m);
    for (int j = 0; j < grid->own_columns; j++) {
        int column = whole(j, grid->column, grid->columns);
        const double *a = grid->values + (size_t)j * grid->lld;
        size_t first = first_row(grid, column), below = first;
        if (first < m && whole(first, grid->row, grid->rows) == column) below++;
        for (int k = 0; k < columns; k++) {
            double scale = x[k * n + column], sum = 0, *to = own_y + k * m;
            const double *from = own_x + k * m;
            if (below > first) to[first] += a[first] * scale;
            for (size_t i = below; i < m; i++) {
                to[i] += a[i] * scale;
                sum += a[i] * from[i];
            }
            y[k * n + column] += sum;
        }
    }
    for (int k = 0; k < columns; k++)
        for (size_t i = 0; i < m; i++) y[k * n + whole(i, grid->row, grid->rows)] += own_y[k * m + i];
    for (int k = 0; k < columns; k++)
        MPI_Reduce(rank == 0 ? MPI_IN_PLACE : y + k * n, rank == 0 ? y + k * n : NULL, grid->n, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) {
        Words to = write_to(file, ".out", -1, n * columns);
        write_words(&to, y, n * columns);
        end_writing(&to);
    }
    free(x), free(y), free(own_x), free(own_y);
}

int invert(Grid *grid, int columns, double sigma, const char *file) {
    int context, descriptor[9], info, one = 1, none = 0, block = BLOCK;
    double *x = vectors(grid, columns, file), *own = get(grid->own_rows + 1, 8);
    for (int k = 0; k < columns; k++) {
        own_part(grid, x + (size_t)k * grid->n, own);
        for (int j = 0; j < grid->own_columns; j++) {
            double scale = sigma * x[(size_t)k * grid->n + whole(j, grid->column, grid->columns)];
            for (int i = 0; i < grid->own_rows; i++) grid->values[(size_t)j * grid->lld + i] += scale * own[i];
        }
    }
    free(x), free(own);
    Cblacs_get(-1, 0, &context);
    Cblacs_gridinit(&context, "R", grid->rows, grid->columns);
    descinit_(descriptor, &grid->n, &grid->n, &block, &block, &none, &none, &context, &grid->lld, &info);
    if (info) die("a grid that ScaLAPACK refuses: %d", info);
    pdpotrf_("L", &grid->n, grid->values, &one, &one, descriptor, &info);
    if (!info) pdpotri_("L", &grid->n, grid->values, &one, &one, descriptor, &info);
    Cblacs_gridexit(context);
    return info;
}
