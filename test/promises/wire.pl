%   What doc/wire.md promises, see ../promises.pl.

promise(server_proves_itself, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    check_proof(In, Deadline, Secret, server, Ours, Theirs).\n"-
        "    line_read(In, Deadline, _).\n").
promise(client_proves_itself, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "    check_proof(In, Deadline, Secret, client, Theirs, Ours),\n"-
        "    line_read(In, Deadline, _),\n").
promise(proof_names_the_role, auth,
        'prolog/typhon/kernel/wire/handshake.pl',
        "[Role, Client, Server]"-"[proof, Client, Server]").
