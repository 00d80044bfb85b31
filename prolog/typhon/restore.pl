:- module(typhon_restore,
          [ restore_write/2,            % +File, +Image
            restore_read/2              % +File, -Image
          ]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(text, [portable/2]).

/** <module> Restore points: agents as text

One fact per line.  The clauses of the program, the state and the goals
still to run can be read, compared and edited.

*Threading*: any thread.
*/

format_version(1).

%!  restore_write(+File, +Image) is det.
%
%   @arg Image is image(Name, Program, Life, State, Goals, Mail)

restore_write(File, Image) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(line(Image, Line), write_line(Out, Line)),
        close(Out)).

write_line(Out, Line) :-
    write_term(Out, Line,
               [ module(system), quoted(true), spacing(next_argument),
                 numbervars(false), portray_goal(typhon_text:portable),
                 fullstop(true), nl(true) ]).

line(_, restore_point(Version)) :-
    format_version(Version).
line(image(Name, _, Life, _, _, _), agent(Name, Life)).
line(image(_, program(Name, State, Libraries, _), _, _, _, _),
     program(Name, State, Libraries)).
line(image(_, program(_, _, _, Clauses), _, _, _, _), clause(Clause)) :-
    member(Clause, Clauses).
line(image(_, _, _, state(PIs, _), _, _), dynamic(PIs)).
line(image(_, _, _, state(_, Clauses), _, _), state(Clause)) :-
    member(Clause, Clauses).
line(image(_, _, _, _, Goals, _), goals(Goals)).
line(image(_, _, _, _, _, Mail), mail(Message)) :-
    member(Message, Mail).

%!  restore_read(+File, -Image) is det.
%
%   @error domain_error(restore_point, File)

restore_read(File, image(Name, program(Program, PIs, Libraries, Clauses),
                         Life, state(Dynamic, State), Goals, Mail)) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_lines(In, Lines),
        close(In)),
    (   Lines = [restore_point(Version)|_],
        format_version(Version),
        memberchk(agent(Name, Life), Lines),
        memberchk(program(Program, PIs, Libraries), Lines),
        memberchk(goals(Goals), Lines),
        memberchk(dynamic(Dynamic), Lines)
    ->  findall(C, member(clause(C), Lines), Clauses),
        findall(C, member(state(C), Lines), State),
        findall(M, member(mail(M), Lines), Mail)
    ;   domain_error(restore_point, File)
    ).

read_lines(In, Lines) :-
    read_term(In, Term, [module(system)]),
    (   Term == end_of_file
    ->  Lines = []
    ;   Lines = [Term|Rest],
        read_lines(In, Rest)
    ).
