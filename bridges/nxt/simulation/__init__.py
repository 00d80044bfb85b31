"""A simulated NXT brick and a world for several of them."""
