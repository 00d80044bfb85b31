:- module(typhon_cell_frames,
          [ cell_frame_write/2,         % +Out, +Term
            cell_frame_read/2,          % +In, -Term
            cell_frame_text/2,          % +In, -Text
            cell_text_heard/2,          % +Text, -Term
            cell_word/2,                % ?Kind, ?PI
            cell_state/2,               % +State0, -State
            state_mark/2,               % +Module, -Mark
            state_changes/3,            % +Module, +Mark, -Changes
            state_predicate/2           % +Module, -Head
          ]).
:- use_module(library(lists), [max_list/2, reverse/2]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [resource_error/1, syntax_error/1]).
:- use_module('../../kernel/base/text', [term_text/2, text_term/2]).
:- use_module('../../kernel/program', [clause_parts/3]).

/** <module> What a gatekeeper and a cell say to each other

Each frame is a length, four bytes, the most significant first, and the
canonical text of one term.  There is no other codec: a record with one wrong
byte can end the process that decodes it.

The gatekeeper sends

    host(Rules, PIs, Limits)    bind the cell to a host: `guarded`, or the text
                                of its rules; what its place offers; and how
                                much agents may use, What-Most
    turn(N, Id, Hash, Program, State, Known, Forget, Goals)
                                run Goals of the agent Id.  Program is as of
                                code_receive/2 or `known`, State as of
                                agent_state/2 or `same`; Known are facts that
                                do not change in a turn; Forget are agents
                                that have left
    answer(N, Answer)           to a request: solutions(Goals), raised(Error),
                                or changed(State, Answer)

and the cell sends

    ready                       once
    told(N, Goals)              words of the agent, in the turn N, that have no
                                answer.  If one raises an error the next answer
                                says so, or the turn ends with that
    request(N, Goal)            a word that has an answer
    changing(N, Goal, Changes)  the same for words that change the state; the
                                agent has made these Changes before
    lacks(N)                    the program or the state of the turn N
    over(N, What)               in the turn N the agent has passed this limit, and
                                the cell ends
    outcome(N, Outcome, Note, Changes)
                                the turn N is over, see machine_run/3

Changes are PI-Clauses, the clauses that a predicate of the state has now.

*Threading*: no state.
*/

%   No state within the default of the quota `state` is larger.

most_bytes(8 388 608).

%!  cell_frame_write(+Out, +Term) is det.
%
%   @error resource_error(cell_frame) Term is too large

cell_frame_write(Out, Term) :-
    term_text(Term, Bytes),
    string_length(Bytes, Length),
    most_bytes(Most),
    (   Length =< Most
    ->  true
    ;   resource_error(cell_frame)
    ),
    L3 is Length>>24, L2 is (Length>>16) /\ 255,
    L1 is (Length>>8) /\ 255, L0 is Length /\ 255,
    string_codes(Head, [L3,L2,L1,L0]),
    write(Out, Head),
    write(Out, Bytes),
    flush_output(Out).

%!  cell_frame_read(+In, -Term) is det.
%
%   Term is `end_of_file` where In ends.

cell_frame_read(In, Term) :-
    (   cell_frame_text(In, Text)
    ->  text_term(Text, Term)
    ;   Term = end_of_file
    ).

%!  cell_text_heard(+Text, -Term) is det.
%
%   Text is of a frame that a cell has written: a number of 30,000 digits is
%   refused, as reading one takes a time that grows with the square of its length,
%   and cannot be interrupted.
%
%   @error syntax_error(Message) it is not the text of one term

cell_text_heard(Text, Term) :-
    no_long_number(Text),
    text_term(Text, Term),
    ( Term == end_of_file -> syntax_error(no_term) ; true ).

%!  cell_frame_text(+In, -Text:string) is semidet.
%
%   Fails where In ends.
%
%   @error syntax_error(Message) the frame is too large: nothing of it was read

cell_frame_text(In, Bytes) :-
    read_string(In, 4, Head),
    string_codes(Head, [L3,L2,L1,L0]),
    Length is L3<<24 \/ L2<<16 \/ L1<<8 \/ L0,
    frame_body(In, Length, Bytes).

frame_body(In, Length, Bytes) :-
    most_bytes(Most),
    (   Length > Most
    ->  syntax_error(frame_too_large)
    ;   read_string(In, Length, Bytes),
        string_length(Bytes, Length)
    ->  true
    ;   syntax_error(truncated_frame)
    ).

                /*******************************
                *         LONG NUMBERS         *
                *******************************/

%   no_long_number(+Bytes): a number of 30,000 digits has a part of 15,000 that
%   begins at a multiple of that.  Digits may be of any base, and blanks may stand
%   between them: text of as many letters and blanks alone is refused, too.
%
%   @error syntax_error(long_number)

no_long_number(Bytes) :-
    (   digits(Bytes, Before, Digits),
        (   sub_string(Digits, _, 1, _, " ")
        ;   number_begins(Bytes, Before, Digits)
        )
    ->  syntax_error(long_number)
    ;   true
    ).

%   digits(+Bytes, -Before, -Digits) is nondet.

digits(Bytes, Before, Digits) :-
    string_length(Bytes, Length),
    Last is Length//15 000 - 1,
    between(0, Last, Part),
    Before is Part*15 000,
    sub_string(Bytes, Before, 15 000, _, Digits),
    split_string(Digits, "", " _0123456789abcdefghijklmnopqrstuvwxyz\c
                              ABCDEFGHIJKLMNOPQRSTUVWXYZ", [""]).

%   number_begins(+Bytes, +Before, +Digits): the word that goes on with Digits
%   begins with a digit, or after 36' or the like.  One that begins before the
%   last 15,000 characters was looked at there.

number_begins(Bytes, Before, Digits) :-
    From is max(0, Before-15 000),
    Length is Before-From,
    sub_string(Bytes, From, Length, _, Text),
    string_codes(Text, Codes),
    reverse(Codes, Reversed),
    string_code(1, Digits, Code),
    word_begins(Reversed, Code, First, Rest),
    ( Rest == [] -> From =:= 0 ; true ),
    (   code_type(First, digit)
    ;   Rest = [0'\',Base|_],
        code_type(Base, digit)
    ),
    !.

word_begins([Code|Codes], _, First, Rest) :-
    code_type(Code, csym),
    !,
    word_begins(Codes, Code, First, Rest).
word_begins(Rest, First, First, Rest).

                /*******************************
                *            WORDS             *
                *******************************/

%!  cell_word(?Kind, ?PI) is nondet.
%
%   What an agent in a cell asks the gatekeeper: Kind is `fixed` if the answer is
%   the same for a whole turn, and goes into the cell with it; `tells` if there
%   is no answer; `looks` if nothing changes; `acts`; or `changes` if that changes
%   the state of the agent.

cell_word(fixed, self/1).
cell_word(fixed, here/1).
cell_word(fixed, home/1).
cell_word(fixed, parent/1).
cell_word(fixed, hops/1).
cell_word(looks, now/1).
cell_word(looks, neighbours/1).
cell_word(looks, neighbour/2).
cell_word(looks, host_load/1).
cell_word(acts, next_host/2).
cell_word(tells, send/2).
cell_word(tells, leave/1).
cell_word(tells, log/1).
cell_word(tells, result/1).
cell_word(tells, message_failed/2).
cell_word(acts, leave_new/1).
cell_word(looks, sense/1).
cell_word(acts, take/1).
cell_word(acts, emit/1).
cell_word(acts, emit/2).
cell_word(acts, withdraw/1).
cell_word(acts, pheromone/3).
cell_word(acts, create/3).
cell_word(acts, monitor/1).
cell_word(acts, monitor/2).
cell_word(acts, unmonitor/1).
cell_word(looks, followers/1).
cell_word(acts, dispose/1).
cell_word(acts, dispose/2).
cell_word(acts, offer/2).
cell_word(acts, unoffer/1).
cell_word(looks, find/3).
cell_word(acts, enter/1).
cell_word(acts, seal/3).
cell_word(acts, unseal/2).
cell_word(changes, attach/1).
cell_word(changes, detach/1).

                /*******************************
                *            STATE             *
                *******************************/

%   What the platform has among the state of an agent, names with `$`, stays
%   with the gatekeeper.

%!  cell_state(+State0, -State) is det.
%
%   State is what of State0 goes into a cell.

cell_state(state(Empty0, Clauses0), state(Empty, Clauses)) :-
    exclude(reserved_indicator, Empty0, Empty),
    exclude(reserved_clause, Clauses0, Clauses).

reserved_indicator(Name/_) :-
    reserved(Name).

reserved_clause(Clause) :-
    clause_parts(Clause, Head, _),
    functor(Head, Name, _),
    reserved(Name).

reserved(Name) :-
    sub_atom(Name, 0, _, _, $).

%!  state_predicate(+Module, -Head) is nondet.

state_predicate(Module, Head) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    functor(Head, Name, _),
    \+ reserved(Name).

%!  state_mark(+Module, -Mark) is det.
%!  state_changes(+Module, +Mark, -Changes:list) is det.
%
%   The state has another Mark when it has changed, in these predicates.

state_mark(Module, Latest/Count) :-
    findall(Last, ( state_predicate(Module, Head), modified(Module, Head, Last) ),
            Lasts),
    length(Lasts, Count),
    max_list([0|Lasts], Latest).

modified(Module, Head, Last) :-
    (   '$get_predicate_attribute'(Module:Head, last_modified_generation, Last0)
    ->  Last = Last0
    ;   Last = 0                        % has never had a clause
    ).

state_changes(Module, Since/_, Changes) :-
    findall(PI-Clauses, changed(Module, Since, PI, Clauses), Changes).

changed(Module, Since, Name/Arity, Clauses) :-
    state_predicate(Module, Head),
    modified(Module, Head, Last),
    Last > Since,
    functor(Head, Name, Arity),
    findall(Clause, state_clause(Module, Head, Clause), Clauses).

state_clause(Module, Head, Clause) :-
    clause(Module:Head, Body),
    ( Body == true -> Clause = Head ; Clause = (Head:-Body) ).
