// Nothing of its own: it is compiled with the headers that most tests include.
