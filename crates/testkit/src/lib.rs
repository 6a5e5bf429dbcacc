//! Statistical tests: χ² for direction samplers, z-tests, furnaces.
