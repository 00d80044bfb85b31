/*  The picture of who imports whom among the rooms of prolog/typhon:

        swipl doc/modules.pl | tred | dot -Tsvg > doc/img/modules.svg

    tred leaves out what follows from other arrows.
*/

:- use_module(library(lists), [member/2]).

:- initialization(picture, main).

:- dynamic rooms/1.             % Directory

:- prolog_load_context(directory, Dir),
   atom_concat(Dir, '/../prolog/typhon', Rooms),
   assertz(rooms(Rooms)).

%   layer(Layer, Colour, Rooms)

layer('for people', '#eeeeee', [tables, messages, near]).
layer(networks, '#fbe3d0',
      [ network, wiring, node, carriers, children, orders, dynamics, log,
        topology ]).
layer(agents, '#fdf3c8',
      [ api, ask, restore, life, effect, birth, hop, arrival, whereabouts,
        post, mailbox, backlog, news, remote, inside, vocabulary, pheromone, strategy, chance,
        agent, context ]).
layer(hosts, '#dcedc8', [hosting, host, place, clock, process, scheduler,
               limits, held, timer]).
layer(programs, '#d6e4f5',
      [ program, faults, source, mobility, machine, code, paths ]).
layer('the wire', '#e6dcf0',
      [ endpoint, keeper, quest, acceptor, connection, reader, request,
        session, outbox, unsent, contacts, refusals, crew, hello, auth, frame,
        text, fifo, aside ]).

picture :-
    rooms(Dir),
    atom_concat(Dir, '/*.pl', Pattern),
    expand_file_name(Pattern, Files),
    format('digraph typhon {~n'),
    format('  rankdir=TB; nodesep=0.15; ranksep=0.35;~n'),
    format('  node [shape=box, style="filled,rounded", fontname=Helvetica, \c
            fontsize=11, height=0.3, color="#888888"];~n'),
    format('  edge [color="#777777", arrowsize=0.6];~n'),
    forall(layer(_, Colour, Rooms),
           forall(member(Room, Rooms),
                  format('  "~w" [fillcolor="~w"];~n', [Room, Colour]))),
    forall(( member(File, Files), import(File, From, To) ),
           format('  "~w" -> "~w";~n', [From, To])),
    format('}~n').

import(File, From, To) :-
    file_base_name(File, Base),
    file_name_extension(From, pl, Base),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        findall(Room, imported(In, Room), Rooms),
        close(In)),
    sort(Rooms, Set),
    member(To, Set).

imported(In, Room) :-
    repeat,
    read(In, Term),
    (   Term == end_of_file
    ->  !,
        fail
    ;   ( Term = (:- use_module(Room, _)) ; Term = (:- use_module(Room)) ;
          Term = (:- reexport(Room, _)) ),
        atom(Room)
    ).
