% Logs the load of its host when it changes; checks it once a second, until the
% agent is disposed of.

:- agent(watchman, [state([last/1])]).

main :-
    host_load(Load),
    note(Load),
    sleep(1),
    main.

note(Load) :-
    last(Load),
    !.
note(Load) :-
    retractall(last(_)),
    assertz(last(Load)),
    log(load(Load)).
