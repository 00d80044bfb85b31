:- module(typhon_saving,
          [ save_network/2,             % +Network, +File
            saved_read/2                % +File, -Terms
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [ existence_error/2, must_be/2, permission_error/3 ]).
:- use_module(library(lists), [append/2, append/3, member/2, numlist/3]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../kernel/base/private', [output_file/2, private_write/2]).
:- use_module('../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../kernel/base/text', [term_text/2, text_term/2]).
:- use_module('../kernel/host',
              [context_now/2, time_due/3, time_kind/1, time_now/1]).
:- use_module('../tools/administration', [host_property/2]).
:- use_module('../kernel/wire', [mobile_term/1]).
:- use_module(node_process, [order_do/2]).
:- use_module(nodes, [node/4, nodes_order/5, nodes_peers/2, nodes_send/3]).
:- use_module(changes, [dynamics_kept/3]).
:- use_module(log_file, [log_size/2]).
:- use_module(networks, [appointments/2, network_state/2]).
:- use_module(plan, [plan_processes/3]).
:- use_module(restarts, [restarts_back/1]).
:- use_module(wiring, [wired/2]).

/** <module> Restore points of whole networks

All processes pause; then each returns its state, and resumes.  The file is
written after that.  Module `loading` loads it.

A file has one clause per line, in canonical text:

    typhon_saved(Version, Prolog, Platform).
    ...
    end(Sum).

Sum is the SHA-256 of all lines before it.  The file is written under a
temporary name and renamed when it is complete; an old file of its name stays
until then.

*Threading*: any thread, also that of virtual time, for goals of network_at/3.
*/

:- multifile
    prolog:error_message//1.

:- setting(hold_seconds, number, 30,
           "Seconds for a network to come to rest before it is saved").

%!  save_network(+Network, +File) is det.
%
%   See network_save/2.

save_network(Network, File) :-
    must_be(atom, Network),
    must_be(ground, File),
    network_state(Network, State),
    once(one_at_a_time(save(Network, State, File))).

%   In virtual time no mutex is needed, as holding time serializes calls; and
%   the thread of virtual time may be a caller, which must not wait for a mutex.

:- meta_predicate one_at_a_time(0).

one_at_a_time(Goal) :-
    (   time_kind(virtual)
    ->  call(Goal)
    ;   with_mutex(typhon_saving, Goal)
    ).

save(Network, State, File) :-
    State = state(Plan, _, _, _),
    plan_processes(Plan, Count, _),
    numlist(1, Count, Ps),
    not_shared(Network),
    restarts_back(Network),
    call_cleanup(collect_state(Network, Ps, State, Terms),
                 resume_all(Network, Ps)),
    saved_write(File, Terms).

%   In virtual time the work of other hosts of this process cannot be separated
%   from that of the network.

not_shared(Network) :-
    context_now(_, Agent),
    Agent \== none,
    !,
    permission_error(save, network, Network).
not_shared(Network) :-
    time_kind(virtual),
    wired(Network, Hosts),
    host_property(Name, address(Address)),
    \+ memberchk(host(_, _, Name, Address), Hosts),
    !,
    permission_error(save, host, Address).
not_shared(_).

runs_here(Network) :-
    node(Network, _, _, local).

collect_state(Network, Ps, State, Terms) :-
    setting(hold_seconds, Seconds),
    deadline(Seconds, Deadline),
    hold(Network, Ps, Deadline),
    about(Network, State, Deadline, About),
    maplist(part(Network, Deadline), Ps, Parts),
    append([About|Parts], Terms).

                /*******************************
                *           HOLDING            *
                *******************************/

%   When no agent gets a turn, and running turns have ended, a message may still
%   be on its way.  Each forwarding leads it to a later location of its agent,
%   so it passes each process at most once.  Hence one round of flushes for each
%   process suffices.

hold(Network, Ps, Deadline) :-
    hold_own_process(Network),
    all_do(Network, Ps, hold, Deadline),
    all_do(Network, Ps, rest([]), Deadline),
    (   runs_here(Network)
    ->  true
    ;   nodes_peers(Network, Peers),
        forall(member(_, [here|Ps]),
               ( all_do(Network, Ps, flush(Peers), Deadline),
                 all_do(Network, Ps, rest(Peers), Deadline) ))
    ).

%   Dynamics and appointments run in this process, also if the hosts run in
%   others.

hold_own_process(Network) :-
    runs_here(Network),
    !.
hold_own_process(_) :-
    order_do(hold(0), ok).

resume_all(Network, Ps) :-
    nodes_send(Network, Ps, let_go),
    (   runs_here(Network)
    ->  true
    ;   order_do(let_go, ok)
    ).

all_do(Network, Ps, What, Deadline) :-
    seconds_to(Deadline, Seconds),
    order(What, Seconds, Order),
    answers(Network, Ps, Order, Deadline, Answers),
    (   memberchk(late, Answers)
    ->  throw(error(timeout_error(save, Network), _))
    ;   true
    ).

order(hold, Seconds, hold(Seconds)).
order(rest(Peers), Seconds, rest(Seconds, Peers)).
order(flush(Peers), Seconds, flush(Seconds, Peers)).

%   The processes get one more second to report that they are late.

answers(Network, Ps, Order, Deadline, Answers) :-
    seconds_to(Deadline, Seconds0),
    Seconds is Seconds0+1,
    nodes_order(Network, Ps, Order, Seconds, Answers).

seconds_to(Deadline, Seconds) :-
    monotonic_time(Now),
    Seconds is max(0.1, Deadline-Now).

                /*******************************
                *          THE STATE           *
                *******************************/

%   about(+Network, +State, +Deadline, -About): About is the part of the
%   state that only this process has.

about(Network, state(Plan, Clock, Log0, Dynamics0), Deadline,
      [network(Network, Plan), clock(Now, Clock), Log, Dynamics|Due]) :-
    time_now(Now),
    dynamics(Dynamics0, Deadline, Network, Dynamics),
    log(Log0, Log),
    appointments(Network, Pairs),
    findall(due(N, Stamp, Goal),
            ( member(N-Goal, Pairs), due(Network, at(N), Stamp) ),
            Due),
    mobile_term(Due).

log(none, log(none, '', 0)).
log(log(Address, File), log(Address, File, Size)) :-
    log_size(File, Size).

dynamics(none, _, _, dynamics(none, none, none)) :-
    !.
dynamics(Dynamics, Deadline, Network, dynamics(Dynamics, Stamp, Then)) :-
    seconds_to(Deadline, Seconds),
    (   dynamics_kept(Dynamics, Seconds, Then)
    ->  due(Dynamics, links, Stamp)
    ;   throw(error(timeout_error(save, Network), _))
    ).

%   An alarm that has fired, but has not been handled, is due at once.

due(Owner, Token, Stamp) :-
    (   time_due(Owner, Token, Stamp0)
    ->  Stamp = Stamp0
    ;   Stamp = 0
    ).

%   part(+Network, +Deadline, +P, -Terms): Terms are the state of process P.

part(Network, Deadline, P, [time(P, Time)|Terms]) :-
    wired(Network, Hosts),
    findall(Name, member(host(P, _, Name, _), Hosts), Names),
    answers(Network, [P], kept(Names), Deadline,
            [kept(Time, Specs, Items)]),
    mobile_term(Time),
    findall(host(P, I, Name, Address, Options),
            ( member(host(P, I, Name, Address), Hosts),
              memberchk(Name-Options, Specs) ),
            HostTerms),
    findall(P:Item, member(Item, Items), ItemTerms),
    append(HostTerms, ItemTerms, Terms).

                /*******************************
                *             FILE             *
                *******************************/

format_version(1).

%   saved_write(+File, +Terms:list) is det.
%
%   @error permission_error(open, source_sink, File),
%   existence_error(source_sink, File)

saved_write(Spec, Terms) :-
    absolute_file_name(Spec, File, [access(none)]),
    output_file(saved_network, File),
    header(Header),
    private_write(File, write_all([Header|Terms])).

write_all(Terms, New) :-
    write_lines(New, write, Terms),
    sum(New, Sum),
    write_lines(New, append, [end(Sum)]).

header(typhon_saved(Version, Prolog, Platform)) :-
    format_version(Version),
    current_prolog_flag(version, Prolog),
    current_prolog_flag(arch, Platform).

write_lines(File, Mode, Terms) :-
    setup_call_cleanup(
        open(File, Mode, Out, [encoding(octet), newline(posix)]),
        forall(member(Term, Terms), write_line(Out, Term)),
        close(Out)).

write_line(Out, Term) :-
    term_text(Term, Bytes),
    format(Out, "~s~n", [Bytes]).

sum(File, Sum) :-
    read_file_to_string(File, Bytes, [encoding(octet)]),
    sum_of(Bytes, Sum).

sum_of(Bytes, Sum) :-
    sha_hash(Bytes, Hash, [algorithm(sha256), encoding(octet)]),
    hash_atom(Hash, Sum).

%!  saved_read(+File, -Terms:list) is det.
%
%   Terms are the saved terms, without the header.
%
%   @error existence_error(source_sink, File)
%   @error network_damaged(File, Why) Why is `no_network`, `cut_short` or
%   `changed`
%   @error network_version(File, Version) the file has another format

saved_read(Spec, Terms) :-
    absolute_file_name(Spec, File, [access(none)]),
    must_be_there(File),
    read_file_to_string(File, Bytes, [encoding(octet)]),
    split_string(Bytes, "\n", "", Parts),
    must_be_ours(Parts, File),
    (   append(Lines, [End, ""], Parts),
        catch(text_term(End, end(Sum)), error(_, _), fail)
    ->  true
    ;   damaged(File, cut_short)
    ),
    before_end(Bytes, End, Body),
    (   sum_of(Body, Sum)
    ->  true
    ;   damaged(File, changed)
    ),
    Lines = [_|Rest],
    maplist(text_term, Rest, Terms).

must_be_there(File) :-
    (   exists_file(File)
    ->  true
    ;   existence_error(source_sink, File)
    ).

%   A file of another format is not parsed.

must_be_ours([First|_], File) :-
    sub_string(First, 0, _, _, "typhon_saved("),
    catch(text_term(First, typhon_saved(Version, _, _)), error(_, _), fail),
    !,
    (   format_version(Version)
    ->  true
    ;   throw(error(network_version(File, Version), _))
    ).
must_be_ours(_, File) :-
    damaged(File, no_network).

before_end(Bytes, End, Body) :-
    string_length(Bytes, Length),
    string_length(End, EndLength),
    Before is Length-EndLength-1,
    sub_string(Bytes, 0, Before, _, Body).

damaged(File, Why) :-
    throw(error(network_damaged(File, Why), _)).

prolog:error_message(timeout_error(save, Network)) -->
    [ '~w has not come to rest in time, and is not saved'-[Network] ].
prolog:error_message(permission_error(save, network, Network)) -->
    [ 'An agent cannot save ~w: it would have to stop before it can'-
      [Network] ].
prolog:error_message(permission_error(save, host, Host)) -->
    [ '~w is not in the network, but has the same virtual time'-[Host] ].
prolog:error_message(network_damaged(File, Why)) -->
    [ '~w: '-[File] ],
    why(Why).
prolog:error_message(network_version(File, Version)) -->
    [ '~w: was saved in format ~w, which this version cannot read'-
      [File, Version] ].

why(no_network) -->
    [ 'is not a file of network_save/2'-[] ].
why(cut_short) -->
    [ 'is cut short'-[] ].
why(changed) -->
    [ 'is not as it was written: its sum is another'-[] ].
