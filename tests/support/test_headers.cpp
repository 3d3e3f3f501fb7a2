// Stands for the headers that all tests have in common.
int main() {}
