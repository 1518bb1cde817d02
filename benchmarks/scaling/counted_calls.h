// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the functions of MPI that count_mpi.c counts: name, kind, bytes that this rank hands over, parameters, arguments.

#ifndef tanktread_benchmarks_counted_calls_h
#define tanktread_benchmarks_counted_calls_h

COUNTED(Isend,
        ISEND,
        size_of(n, type),
        (const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request),
        (data, n, type, to, tag, comm, request))
COUNTED(Issend,
        ISSEND,
        size_of(n, type),
        (const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request),
        (data, n, type, to, tag, comm, request))
COUNTED(Send, SEND, size_of(n, type), (const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm), (data, n, type, to, tag, comm))
COUNTED(
  Sendrecv,
  SENDRECV,
  size_of(n, type),
  (const void *data, int n, MPI_Datatype type, int to, int tag, void *in, int m, MPI_Datatype in_type, int from, int in_tag, MPI_Comm comm, MPI_Status *status),
  (data, n, type, to, tag, in, m, in_type, from, in_tag, comm, status))
COUNTED(Allreduce, ALLREDUCE, size_of(n, type), (const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (in, out, n, type, op, comm))
COUNTED(Iallreduce,
        IALLREDUCE,
        size_of(n, type),
        (const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm, MPI_Request *request),
        (in, out, n, type, op, comm, request))
COUNTED(Reduce,
        REDUCE,
        size_of(n, type),
        (const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm),
        (in, out, n, type, op, root, comm))
COUNTED(Bcast, BCAST, size_of(n, type), (void *data, int n, MPI_Datatype type, int root, MPI_Comm comm), (data, n, type, root, comm))
COUNTED(Exscan, EXSCAN, size_of(n, type), (const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (in, out, n, type, op, comm))
COUNTED(Scan, SCAN, size_of(n, type), (const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm), (in, out, n, type, op, comm))
COUNTED(Allgather,
        ALLGATHER,
        in == MPI_IN_PLACE ? size_of(m, out_type) : size_of(n, type),
        (const void *in, int n, MPI_Datatype type, void *out, int m, MPI_Datatype out_type, MPI_Comm comm),
        (in, n, type, out, m, out_type, comm))
COUNTED(Allgatherv,
        ALLGATHERV,
        in == MPI_IN_PLACE ? size_of(counts[rank_in(comm)], out_type) : size_of(n, type),
        (const void *in, int n, MPI_Datatype type, void *out, const int *counts, const int *starts, MPI_Datatype out_type, MPI_Comm comm),
        (in, n, type, out, counts, starts, out_type, comm))
COUNTED(Alltoall,
        ALLTOALL,
        (in == MPI_IN_PLACE ? size_of(m, out_type) : size_of(n, type)) * n_ranks(comm),
        (const void *in, int n, MPI_Datatype type, void *out, int m, MPI_Datatype out_type, MPI_Comm comm),
        (in, n, type, out, m, out_type, comm))
COUNTED(Alltoallv,
        ALLTOALLV,
        in == MPI_IN_PLACE ? size_of(sum_of(out_counts, comm), out_type) : size_of(sum_of(counts, comm), type),
        (const void  *in,
         const int   *counts,
         const int   *starts,
         MPI_Datatype type,
         void        *out,
         const int   *out_counts,
         const int   *out_starts,
         MPI_Datatype out_type,
         MPI_Comm     comm),
        (in, counts, starts, type, out, out_counts, out_starts, out_type, comm))
COUNTED(Gather,
        GATHER,
        in == MPI_IN_PLACE ? size_of(m, out_type) : size_of(n, type),
        (const void *in, int n, MPI_Datatype type, void *out, int m, MPI_Datatype out_type, int root, MPI_Comm comm),
        (in, n, type, out, m, out_type, root, comm))
COUNTED(Gatherv,
        GATHERV,
        in == MPI_IN_PLACE ? size_of(counts[root], out_type) : size_of(n, type),
        (const void *in, int n, MPI_Datatype type, void *out, const int *counts, const int *starts, MPI_Datatype out_type, int root, MPI_Comm comm),
        (in, n, type, out, counts, starts, out_type, root, comm))
COUNTED(Scatter,
        SCATTER,
        rank_in(comm) == root ? size_of(n, type) * n_ranks(comm) : 0.,
        (const void *in, int n, MPI_Datatype type, void *out, int m, MPI_Datatype out_type, int root, MPI_Comm comm),
        (in, n, type, out, m, out_type, root, comm))
COUNTED(Scatterv,
        SCATTERV,
        rank_in(comm) == root ? size_of(sum_of(counts, comm), type) : 0.,
        (const void *in, const int *counts, const int *starts, MPI_Datatype type, void *out, int m, MPI_Datatype out_type, int root, MPI_Comm comm),
        (in, counts, starts, type, out, m, out_type, root, comm))
COUNTED(Reduce_scatter,
        REDUCE_SCATTER,
        size_of(sum_of(counts, comm), type),
        (const void *in, void *out, const int *counts, MPI_Datatype type, MPI_Op op, MPI_Comm comm),
        (in, out, counts, type, op, comm))
COUNTED(Barrier, BARRIER, 0., (MPI_Comm comm), (comm))
COUNTED(Ibarrier, IBARRIER, 0., (MPI_Comm comm, MPI_Request *request), (comm, request))
COUNTED(Wait, WAIT, 0., (MPI_Request * request, MPI_Status *status), (request, status))
COUNTED(Waitall, WAITALL, 0., (int n, MPI_Request *requests, MPI_Status *statuses), (n, requests, statuses))
COUNTED(Waitsome, WAITSOME, 0., (int n, MPI_Request *requests, int *n_done, int *done, MPI_Status *statuses), (n, requests, n_done, done, statuses))
COUNTED(Waitany, WAITANY, 0., (int n, MPI_Request *requests, int *done, MPI_Status *status), (n, requests, done, status))
COUNTED(Recv, RECV, 0., (void *data, int n, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Status *status), (data, n, type, from, tag, comm, status))
COUNTED(Probe, PROBE, 0., (int from, int tag, MPI_Comm comm, MPI_Status *status), (from, tag, comm, status))

#endif
