//! Queues of path states and the loop over them.
