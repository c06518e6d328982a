//! Dynamics of open-chain robots in the screw notation of Lynch and Park.
