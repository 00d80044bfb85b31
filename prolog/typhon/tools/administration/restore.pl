:- module(typhon_restore,
          [ save_agent/2,               % +Agent, +File
            load_agent/3,               % +File, -Agent, +Options
            restore_point/2             % +File, +Image
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/base/private', [output_file/2, private_open/4]).
:- use_module('../../kernel/base/text', [write_portable/3]).
:- use_module('../../kernel/program',
              [ code_receive/2, code_extras/2, code_sent/2, code_unwrapped/3,
                code_wrapped/3, program_hash/2 ]).
:- use_module('../../kernel/wire', [mobile_term/1]).
:- use_module('../../kernel/host', [amended/5]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_name/3, agent_state/2, agent_status/3, is_life/1,
                mail_list/2 ]).
:- use_module('../../kernel/lifecycle', [agent_begin/4, order_give/3]).

/** <module> Restore points: agents as text

A file has one fact per line, so that people can read, compare and edit the
clauses of the program, the state and the remaining goals.

*Threading*: any thread.
*/

:- multifile
    typhon_options:declared/4,
    typhon_orders:carried_out/3.

%!  save_agent(+Agent, +File) is det.
%!  load_agent(+File, -Agent, +Options) is det.
%
%   As agent_save/2 and agent_load/3.

save_agent(Agent, File) :-
    order_give(Agent, image, Image),
    once(write_image(File, Image)).

typhon_orders:carried_out(image, Agent,
                          image(Name, Program, Life, State, Goals,
                                Mail)) :-
    agent(Agent, Host, Module, Hash, Life),
    agent_status(Agent, _, Goals),
    code_sent(Hash, Program),
    agent_name(Agent, Name, _),
    agent_state(Module, State0),
    amended(copied, Host, Agent, State0, State),
    mail_list(Agent, Mail),
    mobile_term(State-Goals).

load_agent(File, Agent, Options) :-
    must_be(var, Agent),
    check_options(load_option, Options),
    once(read_image(File, Image)),
    Image = image(Name, Sent, Life, State, Goals, Mail),
    program_places(Sent, Program, _),
    program_hash(Program, Hash),
    code_receive(Hash, Sent),
    agent_begin(Options, Name, start(Hash, Life, State, Goals, Mail), Agent).

%!  restore_point(+File, +Image) is det.
%
%   Write a restore point of an agent that is on no running host.  Image is
%   image(Name, Program, Life, State, Goals, Mail), with Program as of
%   code_sent/2.

restore_point(File, Image) :-
    write_image(File, Image).

typhon_options:declared(load_option, host(Host), atom, Host).

                /*******************************
                *            THE FILE          *
                *******************************/

format_version(1).

%   write_image(+File, +Image), read_image(+File, -Image): Image is
%   image(Name, Sent, Life, State, Goals, Mail), with Sent as of code_sent/2.
%
%   The text is complete before File is opened: if it cannot be made, an earlier
%   restore point in File is kept.

write_image(File, Image) :-
    output_file(restore_point, File),
    with_output_to(string(Text), forall(line(Image, Line), write_line(Line))),
    setup_call_cleanup(
        private_open(File, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).

write_line(Line) :-
    write_portable(current_output, Line,
                   [ module(system), spacing(next_argument), fullstop(true),
                     nl(true) ]).

line(_, restore_point(Version)) :-
    format_version(Version).
line(image(Name, _, Life, _, _, _), agent(Name, Life)).
line(image(_, Sent, _, _, _, _), program(Name, State, Libraries)) :-
    program_places(Sent, program(Name, State, Libraries, _), _).
line(image(_, Sent, _, _, _, _), clause(Clause)) :-
    program_places(Sent, program(_, _, _, Clauses), _),
    member(Clause, Clauses).
line(image(_, Sent, _, _, _, _), places(Places)) :-
    program_places(Sent, _, Places),
    Places \== [].
line(image(_, Sent, _, _, _, _), Extra) :-
    code_unwrapped(Sent, _, Extras),
    member(Extra, Extras).
line(image(_, _, _, state(PIs, _), _, _), dynamic(PIs)).
line(image(_, _, _, state(_, Clauses), _, _), state(Clause)) :-
    member(Clause, Clauses).
line(image(_, _, _, _, Goals, _), goals(Goals)).
line(image(_, _, _, _, _, Mail), mail(Message)) :-
    member(Message, Mail).

program_places(Sent0, Program, Places) :-
    code_unwrapped(Sent0, Sent, _),
    (   Sent = Program0-Places0
    ->  Program = Program0,
        Places = Places0
    ;   Program = Sent,
        Places = []
    ).

read_image(File, image(Name, Sent, Life, state(Dynamic, State), Goals, Mail)) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_lines(In, Lines),
        close(In)),
    (   Lines = [restore_point(Version)|_],
        format_version(Version),
        memberchk(agent(Name, Life), Lines),
        is_life(Life),
        memberchk(program(Program, PIs, Libraries), Lines),
        memberchk(goals(Goals), Lines),
        memberchk(dynamic(Dynamic), Lines)
    ->  ( memberchk(places(Places), Lines) -> true ; Places = [] ),
        findall(C, member(clause(C), Lines), Clauses),
        Sent0 = program(Program, PIs, Libraries, Clauses)-Places,
        code_extras(Lines, Extras),
        code_wrapped(Extras, Sent0, Sent),
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
