//! C interface to the Poincaré-Chetaev equations
