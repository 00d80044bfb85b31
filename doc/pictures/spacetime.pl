:- module(doc_pictures_spacetime,
          [ spacetime_picture/1         % +Directory
          ]).

/** <module> Three scouts and their clones, for doc/looking.md

In virtual time, so the picture is the same whenever it is made.

*Threading*: the main thread.
*/

:- use_module('../../prolog/typhon',
              [ agent_create/3, agent_join/3, network_start/3, network_stop/1
              ]).
:- use_module('../../app/typhon/picture', [picture/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).

%!  spacetime_picture(+Directory) is det.
%
%   Write spacetime.svg.

spacetime_picture(Directory) :-
    tmp_file(scouts, Log),
    setup_call_cleanup(
        network_start(grid(2, 4), Network,
                      [ clock(virtual), seed(1), hop_time(uniform(1, 3)),
                        log(Log, [hops, messages]) ]),
        scouts,
        network_stop(Network)),
    directory_file_path(Directory, 'spacetime.svg', File),
    picture(Log, File, []),
    delete_file(Log),
    format('~w~n', [File]).

scouts :-
    scout(Clauses),
    findall(Scout,
            ( member(Name-Host, [ann-n1, bob-n4, cleo-n6]),
              agent_create(clauses(Clauses), Scout,
                           [host(Host), name(Name)]) ),
            Scouts),
    forall(member(Scout, Scouts), agent_join(family(Scout), _, 1000)).

%   After two moves the scout clones itself; the clone moves on, and sends its
%   host to the scout, which returns home.

scout([ (:- agent(scout, [])),
        (main :-
             walk(2),
             next_host(conscientious, Host),
             clone(Host, Who),
             part(Who)),
        (part(clone(Scout)) :-
             sleep(1),
             walk(1),
             here(Here),
             log(seen(Here)),
             send(Scout, seen(Here))),
        (part(parent(_)) :-
             receive(_-seen(_), 20),
             home(Home),
             move(Home)),
        walk(0),
        (walk(N) :-
             N > 0,
             sleep(1),
             next_host(conscientious, Host),
             move(Host),
             N1 is N-1,
             walk(N1))
      ]).
