//! Photon records, the kd-tree and density estimation.
