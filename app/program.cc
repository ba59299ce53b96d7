// A program of Feldspar: all of it lies in the library that it is linked with.

extern "C" int feldspar_main(int argc, char** argv);

int main(int argc, char** argv) { return feldspar_main(argc, argv); }
