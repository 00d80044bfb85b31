:- module(typhon_bounds,
          [ memory_short/0,
            memory_short/1,             % +Count
            space_used_up/1,            % +Module
            bounded/3                   % :Fact, +Setting, :Add
          ]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(settings), [setting/2]).

/** <module> Bounds of a process: memory, and tables that forget

A process with a limited address space (ulimit -v, prlimit --as) ends when an
allocation fails in any of its threads.  So the numbers of agents and of
workers do not grow while less than a quarter is left.

*Threading*: any thread.
*/

:- dynamic short/0.             % memory was short at the last check

%!  space_used_up(+Module) is semidet.
%
%   The program space of Module is bounded, and less than a tenth is left: an
%   error that says so is true.

space_used_up(Module) :-
    module_property(Module, program_space(Most)),
    Most > 0,
    module_property(Module, program_size(Size)),
    10*Size > 9*Most.

%!  memory_short is semidet.
%!  memory_short(+Count) is semidet.
%
%   The address space of this process is limited, and less than a quarter of it
%   is left.  With Count, the number of items of a growing table, this is
%   checked only for one item in 256, and for each item while memory is short.

memory_short(Count) :-
    (   short
    ->  true
    ;   Count /\ 0xff =:= 0
    ),
    (   memory_short
    ->  ( short -> true ; assertz(short) )
    ;   retractall(short),
        fail
    ).

memory_short :-
    left(Limit, Left),
    Left < Limit//4.

%   left(-Limit, -Left): bytes; fails if there is no limit, or it is unknown.

left(Limit, Left) :-
    limit(Limit),
    size(Size),
    reusable(Reusable),
    Left is Limit-Size+Reusable.

limit(Limit) :-
    file_text('/proc/self/limits', Text),
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    string_concat("Max address space", Rest, Line),
    !,
    split_string(Rest, " ", " ", Words),
    member(Word, Words),
    Word \== "",
    !,
    number_string(Limit, Word).

size(Size) :-
    file_text('/proc/self/status', Text),
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    string_concat("VmSize:", Rest, Line),
    !,
    split_string(Rest, "", "\t kB", [Word]),
    number_string(Kilobytes, Word),
    Size is Kilobytes*1024.

file_text(File, Text) :-
    catch(setup_call_cleanup(open(File, read, In),
                             read_string(In, _, Text),
                             close(In)),
          error(_, _), fail).

%   Memory that malloc has freed remains part of the address space, and malloc
%   can reuse it.

reusable(Bytes) :-
    (   predicate_property(malloc_property(_), defined)
    ->  findall(Free, free_pages(Free), Frees),
        sum_list(Frees, Bytes)
    ;   Bytes = 0
    ).

%   A Prolog without tcmalloc has no malloc_property/1.

free_pages(Bytes) :-
    member(Name, [ 'tcmalloc.pageheap_free_bytes',
                   'tcmalloc.pageheap_unmapped_bytes' ]),
    Property =.. [Name, Bytes],
    Goal = malloc_property(Property),
    call(Goal).

                /*******************************
                *           BOUNDED            *
                *******************************/

:- meta_predicate bounded(0, +, 0).

:- multifile forgotten/1.               % Fact: it was deleted

%!  bounded(:Fact, +Setting, :Add) is det.
%
%   Call Add, which adds a fact that matches Fact, after the oldest of them were
%   deleted, so that there are never more than the setting Setting, module:name,
%   allows.  A lower setting holds after at most a hundred additions.  The mutex
%   is that of the table.

bounded(Fact, Setting, Add) :-
    Setting = Module:Name,
    atomic_list_concat([Module, Name], :, Table),
    with_mutex(Table, added(Table, Fact, Setting, Add, Forgotten)),
    (   Forgotten == []
    ->  true
    ;   report_forgotten(Forgotten)
    ).

%   The flag Table: so many facts can be added before the next look.

added(Table, Fact, Setting, Add, Forgotten) :-
    get_flag(Table, Room),
    (   Room > 0
    ->  Forgotten = []
    ;   make_room(Table, Fact, Setting, Forgotten)
    ),
    call(Add),
    get_flag(Table, Room1),
    Room2 is Room1-1,
    set_flag(Table, Room2).

%   Of a large table a hundred facts are deleted at a time.

make_room(Table, Fact, Setting, Forgotten) :-
    setting(Setting, Max),
    predicate_property(Fact, number_of_clauses(Count)),
    Some is max(1, min(100, Max//100)),
    Excess is Count+Some-Max,
    findall(Fact, ( between(1, Excess, _), once(retract(Fact)) ), Forgotten),
    length(Forgotten, Deleted),
    Room is max(1, min(100, Max-Count+Deleted)),
    set_flag(Table, Room).

%   Modules that have related data delete it.

report_forgotten(Forgotten) :-
    forall(( member(_:Fact, Forgotten), forgotten(Fact) ), true).
