"""One step of many paths at a time: the stages that every integrator is made of."""
