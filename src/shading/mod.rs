//! Pure functions of light and surface.
