//! Nothing that culls may lose what decides.
