//! Operations of MPI under way, with the memory they work on.
//!
//! MPI reads and writes the memory until the operation is complete. Each operation owns its memory, gives it out
//! only when complete, and waits when dropped.

use ::mpi::ffi;
use ::mpi::raw::AsRaw;
use ::mpi::topology::SimpleCommunicator;
use ::mpi::{Count, Rank, Tag};

/// A request that is waited for before it goes.
struct Request(ffi::MPI_Request);

impl Request {
    /// Whether the operation is complete.
    fn done(&mut self) -> bool {
        let mut flag = 0;
        // SAFETY: the request is one of MPI's or null, which counts as complete; MPI runs as long as there are
        // operations (the owner drops them first).
        unsafe { ffi::MPI_Test(&mut self.0, &mut flag, ffi::RSMPI_STATUS_IGNORE) };
        flag != 0
    }

    /// Waits for a receive, and how many bytes came.
    fn wait_for_bytes(&mut self) -> usize {
        let mut count: Count = 0;
        // SAFETY: as for `done`; a status is plain data that MPI fills, and the message consists of bytes.
        unsafe {
            let mut status: ffi::MPI_Status = std::mem::zeroed();
            ffi::MPI_Wait(&mut self.0, &mut status);
            ffi::MPI_Get_count(&status, ffi::RSMPI_UINT8_T, &mut count);
        }
        usize::try_from(count).unwrap_or(0)
    }

    /// Gives a receive up; it is complete, one way or the other, once it has been waited for.
    fn cancel(&mut self) {
        if !self.done() {
            // SAFETY: as for `done`, and the request is not null, since it is not complete.
            unsafe { ffi::MPI_Cancel(&mut self.0) };
        }
    }

    fn wait(&mut self) {
        // SAFETY: as for `done`; a completed request is null, for which this returns at once.
        unsafe { ffi::MPI_Wait(&mut self.0, ffi::RSMPI_STATUS_IGNORE) };
    }
}

impl Drop for Request {
    fn drop(&mut self) {
        self.wait();
    }
}

/// A message being sent. The request is dropped first, then the memory.
pub(super) struct PendingSend {
    request: Request,
    _message: Vec<u8>,
}

impl PendingSend {
    /// Of a message that is short enough to be counted.
    pub(super) fn start(world: &SimpleCommunicator, dest: Rank, tag: Tag, message: Vec<u8>) -> PendingSend {
        // SAFETY: null requests are constants of MPI.
        let mut request = Request(unsafe { ffi::RSMPI_REQUEST_NULL });
        // SAFETY: the message's bytes stay where they are, unchanged, until the request is complete: the vector is
        // kept beside it and not touched, and moving a vector does not move its elements.
        unsafe {
            ffi::MPI_Isend(
                message.as_ptr().cast(),
                message.len() as Count,
                ffi::RSMPI_UINT8_T,
                dest,
                tag,
                world.as_raw(),
                &mut request.0,
            );
        }
        PendingSend { request, _message: message }
    }

    pub(super) fn done(&mut self) -> bool {
        self.request.done()
    }
}

/// Memory that waits for a message. The request is dropped first, then the memory; a message that never comes is
/// not waited for.
pub(super) struct PendingReceive {
    request: Request,
    memory: Vec<u8>,
}

impl PendingReceive {
    /// For a message of at most `room` bytes, which is short enough to be counted; MPI ends all ranks at a longer one.
    pub(super) fn start(world: &SimpleCommunicator, source: Rank, tag: Tag, room: usize) -> PendingReceive {
        let mut memory = vec![0u8; room];
        // SAFETY: null requests are constants of MPI.
        let mut request = Request(unsafe { ffi::RSMPI_REQUEST_NULL });
        // SAFETY: the memory has that many bytes and stays where it is, untouched, until the request is complete.
        unsafe {
            ffi::MPI_Irecv(
                memory.as_mut_ptr().cast(),
                memory.len() as Count,
                ffi::RSMPI_UINT8_T,
                source,
                tag,
                world.as_raw(),
                &mut request.0,
            );
        }
        PendingReceive { request, memory }
    }

    /// The message; nothing waits afterwards.
    pub(super) fn wait(&mut self) -> Vec<u8> {
        let bytes = self.request.wait_for_bytes();
        self.memory.truncate(bytes);
        std::mem::take(&mut self.memory)
    }
}

impl Drop for PendingReceive {
    fn drop(&mut self) {
        self.request.cancel();
    }
}

#[derive(Clone, Copy)]
pub(super) enum Operation {
    Sum,
    Maximum,
}

/// Words being reduced over all ranks. The request is dropped first, then the memory.
pub(super) struct PendingReduction {
    request: Request,
    _own: Vec<u64>,
    reduced: Vec<u64>,
}

impl PendingReduction {
    /// Of equally many words on every rank, few enough to be counted.
    pub(super) fn start(world: &SimpleCommunicator, operation: Operation, own: Vec<u64>) -> PendingReduction {
        let mut reduced = vec![0u64; own.len()];
        // SAFETY: null requests and operations are constants of MPI.
        let (mut request, operation) = unsafe {
            let operation = match operation {
                Operation::Sum => ffi::RSMPI_SUM,
                Operation::Maximum => ffi::RSMPI_MAX,
            };
            (Request(ffi::RSMPI_REQUEST_NULL), operation)
        };
        // SAFETY: both vectors have that many words, do not overlap, and are kept untouched beside the request until
        // it is complete.
        unsafe {
            ffi::MPI_Iallreduce(
                own.as_ptr().cast(),
                reduced.as_mut_ptr().cast(),
                own.len() as Count,
                ffi::RSMPI_UINT64_T,
                operation,
                world.as_raw(),
                &mut request.0,
            );
        }
        PendingReduction { request, _own: own, reduced }
    }

    pub(super) fn wait(mut self) -> Vec<u64> {
        self.request.wait();
        std::mem::take(&mut self.reduced)
    }
}
