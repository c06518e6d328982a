//! Reads URDF robot descriptions.
