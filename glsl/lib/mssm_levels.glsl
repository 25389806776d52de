// Lowest MSSM level whose nodes cover `side` cells.
int level_covering(int side) { return side <= 1 ? 0 : findMSB(side - 1) + 1; }
