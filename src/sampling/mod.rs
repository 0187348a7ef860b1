//! Counter-based random numbers, low-discrepancy points and pixel filters.
