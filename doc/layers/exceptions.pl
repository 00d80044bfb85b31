exception('prolog/typhon/kernel/host/host_options.pl',journal).
exception('prolog/typhon/kernel/program/advice.pl',snapshot).
