exception('prolog/typhon/kernel/program/advice.pl',snapshot).
