	.syntax	unified
	.eabi_attribute	67, "2.09"
	.eabi_attribute	6, 13
	.eabi_attribute	7, 77
	.eabi_attribute	8, 0
	.eabi_attribute	9, 2
	.fpu	fpv4-sp-d16
	.eabi_attribute	27, 1
	.eabi_attribute	36, 1
	.eabi_attribute	34, 1
	.eabi_attribute	17, 1
	.eabi_attribute	20, 1
	.eabi_attribute	21, 1
	.eabi_attribute	23, 3
	.eabi_attribute	24, 1
	.eabi_attribute	25, 1
	.eabi_attribute	28, 1
	.eabi_attribute	38, 1
	.eabi_attribute	14, 0
	.file	"bare.b9ae86c51309bd74-cgu.0"
	.section	.text._start,"ax",%progbits
	.globl	_start
	.p2align	3
	.type	_start,%function
	.code	16
	.thumb_func
_start:
.Lfunc_begin0:
	.fnstart
	.cfi_sections .debug_frame
	.cfi_startproc
	.save	{r7, lr}
	push	{r7, lr}
	.cfi_def_cfa_offset 8
	.cfi_offset lr, -4
	.cfi_offset r7, -8
	.setfp	r7, sp
	mov	r7, sp
	.cfi_def_cfa_register r7
	.pad	#48
	sub	sp, #48
	ldr.w	r0, .LCPI0_0
	add.w	r9, sp, #8
	ldrd	r4, r1, [r0]
	ldrd	r1, r2, [r0]
	movs	r2, #0
.LBB0_1:
	cmp	r2, #8
	beq	.LBB0_3
	ldrd	r3, r5, [r0]
	strb.w	r3, [r9, r2]
	adds	r2, #1
	b	.LBB0_1
.LBB0_3:
	and	r6, r1, #1
	ldrd	r0, r1, [r0]
	uxtb	r5, r0
	cmp	r5, #7
	bhi	.LBB0_6
	cbnz	r5, .LBB0_7
	movs	r0, #0
	movs	r1, #0
	movs	r2, #0
	b	.LBB0_8
.LBB0_6:
	movs	r5, #8
.LBB0_7:
	movs	r0, #64
	sub.w	r2, r0, r5, lsl #3
	mov.w	r0, #-1
	mov.w	r1, #-1
	bl	__aeabi_llsr
	movs	r2, #0
	cmp	r5, #7
	it	hi
	movhi	r2, #1
.LBB0_8:
	movw	r3, #2047
	cmp	r6, #0
	itt	ne
	mvnne	r3, #-536870912
	cmpne	r2, #0
	beq	.LBB0_13
	ands	r3, r4
	mvn	r2, #248
	movs	r5, #0
	movs	r6, #0
	uxtab	r12, r2, r3, ror #8
	mvn	r2, #239
	cmn.w	r12, #9
	uxtab	r2, r2, r4
	it	lo
	movlo	r6, #1
	cmp	r2, #9
	it	lo
	movlo	r5, #1
	eors	r5, r6
	bne	.LBB0_13
	ubfx	r2, r3, #16, #6
	subs	r3, r2, #1
	cmp	r3, #30
	bhi	.LBB0_13
	ldrd	r2, r4, [sp, #8]
	and.w	r8, r4, r1
	and.w	r11, r2, r0
.LCPI0_3:
	tbb	[pc, r3]
.LJTI0_0:
	.byte	(.LBB0_14-(.LCPI0_3+4))/2
	.byte	(.LBB0_21-(.LCPI0_3+4))/2
	.byte	(.LBB0_28-(.LCPI0_3+4))/2
	.byte	(.LBB0_26-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_18-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_23-(.LCPI0_3+4))/2
	.byte	(.LBB0_30-(.LCPI0_3+4))/2
	.byte	(.LBB0_32-(.LCPI0_3+4))/2
	.byte	(.LBB0_41-(.LCPI0_3+4))/2
	.byte	(.LBB0_36-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_17-(.LCPI0_3+4))/2
	.byte	(.LBB0_25-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_20-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_16-(.LCPI0_3+4))/2
	.byte	(.LBB0_34-(.LCPI0_3+4))/2
	.byte	(.LBB0_35-(.LCPI0_3+4))/2
	.byte	(.LBB0_45-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_13-(.LCPI0_3+4))/2
	.byte	(.LBB0_43-(.LCPI0_3+4))/2
	.p2align	1
.LBB0_13:
	yield
	b	.LBB0_13
.LBB0_14:
	cmn.w	r12, #9
	bhs.w	.LBB0_51
	movs	r5, #0
	movs	r1, #0
	movs	r2, #0
	movs	r3, #0
	movs	r0, #0
	b	.LBB0_61
.LBB0_16:
	bl	OUTLINED_FUNCTION_3
	it	ne
	movne.w	r11, #2
	cmp	r3, #0
	it	eq
	moveq	r11, r3
	movs	r0, #23
	b	.LBB0_44
.LBB0_17:
	bl	OUTLINED_FUNCTION_3
	it	ne
	movne.w	r11, #2
	cmp	r3, #0
	it	eq
	moveq	r11, r3
	movs	r0, #20
	b	.LBB0_44
.LBB0_18:
	cmn.w	r12, #9
	bhs.w	.LBB0_46
	movs	r0, #8
	b	.LBB0_38
.LBB0_20:
	movs	r0, #22
	b	.LBB0_48
.LBB0_21:
	cmn.w	r12, #9
	bhs.w	.LBB0_47
	movs	r0, #2
	b	.LBB0_38
.LBB0_23:
	cmn.w	r12, #9
	bhs.w	.LBB0_49
	movs	r0, #10
	b	.LBB0_38
.LBB0_25:
	bl	OUTLINED_FUNCTION_3
	it	ne
	movne.w	r11, #2
	cmp	r3, #0
	it	eq
	moveq	r11, r3
	movs	r0, #21
	b	.LBB0_44
.LBB0_26:
	cmn.w	r12, #9
	bhs.w	.LBB0_50
	movs	r0, #6
	b	.LBB0_38
.LBB0_28:
	cmn.w	r12, #9
	bhs.w	.LBB0_52
	movs	r0, #4
	b	.LBB0_38
.LBB0_30:
	cmn.w	r12, #9
	bhs.w	.LBB0_53
	movs	r0, #12
	b	.LBB0_38
.LBB0_32:
	movs	r5, #0
	cmn.w	r12, #9
	bhs.w	.LBB0_54
	movs	r0, #14
	b	.LBB0_39
.LBB0_34:
	bl	OUTLINED_FUNCTION_3
	it	ne
	movne.w	r11, #2
	cmp	r3, #0
	it	eq
	moveq	r11, r3
	movs	r0, #24
	b	.LBB0_44
.LBB0_35:
	rev.w	r0, r11
	bl	OUTLINED_FUNCTION_2
	vldr	d0, .LCPI0_1
	vmov	r6, r4, d0
	mov	r2, r6
	mov	r3, r4
	bl	__aeabi_ddiv
	bl	OUTLINED_FUNCTION_4
	mov	r2, r6
	mov	r3, r4
	mov	r6, r11
	bl	__aeabi_ddiv
	vmov	d8, r0, r1
	movs	r0, #25
	b	.LBB0_58
.LBB0_36:
	cmn.w	r12, #9
	bhs.w	.LBB0_56
	movs	r0, #18
.LBB0_38:
	movs	r5, #0
.LBB0_39:
	movs	r1, #0
	movs	r2, #0
.LBB0_40:
	b	.LBB0_59
.LBB0_41:
	movs	r5, #0
	cmn.w	r12, #9
	bhs.w	.LBB0_57
	movs	r0, #16
	b	.LBB0_39
.LBB0_43:
	bl	OUTLINED_FUNCTION_3
	it	ne
	movne.w	r11, #2
	cmp	r3, #0
	it	eq
	moveq	r11, r3
	movs	r0, #27
.LBB0_44:
	movs	r5, #0
	movs	r1, #0
	movs	r2, #0
	b	.LBB0_61
.LBB0_45:
	rev.w	r0, r11
	bl	OUTLINED_FUNCTION_2
	vldr	d0, .LCPI0_1
	bl	OUTLINED_FUNCTION_0
	bl	OUTLINED_FUNCTION_4
	mov	r3, r6
	mov	r2, r4
	mov	r6, r11
	bl	__aeabi_ddiv
	vmov	d8, r0, r1
	movs	r0, #26
	b	.LBB0_58
.LBB0_46:
	rev.w	r0, r8
	movs	r1, #0
	lsrs	r0, r0, #16
	movs	r5, #0
	bl	__aeabi_ul2d
	vldr	d0, .LCPI0_2
	vmov	r6, r8, d0
	bl	OUTLINED_FUNCTION_7
	rev.w	r4, r11
	strd	r1, r0, [sp]
	uxth	r0, r4
	movs	r1, #0
	bl	__aeabi_ul2d
	bl	OUTLINED_FUNCTION_7
	vmov	d8, r0, r1
	lsrs	r0, r4, #16
	movs	r1, #0
	bl	__aeabi_ul2d
	bl	OUTLINED_FUNCTION_7
	mov	r6, r0
	mov	r10, r1
	ldrd	r1, r0, [sp]
	vmov	d9, r0, r1
	movs	r0, #9
	b	.LBB0_55
.LBB0_47:
	lsr.w	r0, r11, #16
	orr.w	r11, r0, r8, lsl #16
	movs	r0, #3
.LBB0_48:
	movs	r5, #0
	movs	r1, #0
	movs	r2, #0
	movs	r3, #0
	b	.LBB0_61
.LBB0_49:
	rev.w	r0, r8
	bl	OUTLINED_FUNCTION_2
	vldr	d0, .LCPI0_1
	bl	OUTLINED_FUNCTION_0
	bl	OUTLINED_FUNCTION_5
	bl	OUTLINED_FUNCTION_1
	mov	r6, r0
	ldr	r0, [sp, #4]
	mov	r10, r1
	vmov	d8, r8, r0
	movs	r0, #11
	b	.LBB0_58
.LBB0_50:
	rev.w	r0, r11
	rev.w	r1, r8
	lsrs	r2, r1, #16
	lsrs	r3, r1, #24
	orr.w	r4, r2, r0, lsl #16
	lsrs	r2, r1, #8
	orr.w	r2, r2, r0, lsl #24
	lsr.w	r11, r0, #8
	movs	r0, #7
	movs	r5, #0
	b	.LBB0_61
.LBB0_51:
	bl	OUTLINED_FUNCTION_6
	movs	r0, #1
	b	.LBB0_40
.LBB0_52:
	bl	OUTLINED_FUNCTION_6
	movs	r0, #5
	b	.LBB0_40
.LBB0_53:
	rev.w	r0, r8
	bl	OUTLINED_FUNCTION_2
	vldr	d0, .LCPI0_1
	bl	OUTLINED_FUNCTION_0
	bl	OUTLINED_FUNCTION_5
	bl	OUTLINED_FUNCTION_1
	mov	r6, r0
	ldr	r0, [sp, #4]
	mov	r10, r1
	vmov	d8, r8, r0
	movs	r0, #13
	b	.LBB0_58
.LBB0_54:
	rev.w	r4, r8
	movs	r1, #10
	uxth	r0, r4
	umull	r0, r1, r0, r1
	bl	__aeabi_ul2d
	rev.w	r2, r11
	lsrs	r3, r4, #16
	vmov	d8, r0, r1
	movs	r1, #0
	orr.w	r3, r3, r2, lsl #16
	pkhtb	r2, r3, r2, asr #16
	uxth	r0, r3
	vmov	d9, r2, r5
	bl	__aeabi_ul2d
	vldr	d0, .LCPI0_2
	vmov	r2, r3, d0
	bl	__aeabi_ddiv
	mov	r6, r0
	mov	r10, r1
	movs	r0, #15
.LBB0_55:
	movs	r1, #0
	movs	r2, #0
	b	.LBB0_60
.LBB0_56:
	rev.w	r8, r11
	movs	r1, #0
	movs	r5, #0
	uxth.w	r0, r8
	bl	__aeabi_ul2d
	vldr	d0, .LCPI0_2
	bl	OUTLINED_FUNCTION_0
	vmov	d8, r0, r1
	lsr.w	r0, r8, #16
	movs	r1, #0
	bl	__aeabi_ul2d
	bl	OUTLINED_FUNCTION_1
	mov	r6, r0
	mov	r10, r1
	movs	r0, #19
	b	.LBB0_58
.LBB0_57:
	rev.w	r0, r11
	rev.w	r1, r8
	lsrs	r2, r1, #16
	orr.w	r6, r2, r0, lsl #16
	lsrs	r2, r0, #8
	pkhbt	r1, r1, r2
	ubfx	r10, r0, #16, #8
	movs	r0, #17
	vmov	d8, r1, r5
.LBB0_58:
	movs	r1, #0
	movs	r2, #0
.LBB0_59:
.LBB0_60:
	movs	r3, #0
.LBB0_61:
	strb.w	r0, [sp, #8]
	lsls	r0, r5, #16
	bfi	r0, r1, #8, #8
	uxtb	r1, r2
	add	r0, r1
	str	r6, [sp, #16]
	vstr	d9, [sp, #32]
	vstr	d8, [sp, #24]
	strb.w	r4, [sp, #11]
	strb.w	r3, [sp, #10]
	strb.w	r11, [sp, #9]
	str.w	r10, [sp, #20]
	str	r0, [sp, #12]
	str.w	r9, [sp, #44]
	add	r0, sp, #44
	@APP
	@NO_APP
	b	.LBB0_13
	.p2align	3
.LCPI0_1:
	.long	0
	.long	1083129856
.LCPI0_2:
	.long	0
	.long	1076101120
.LCPI0_0:
	.long	_ZN46_$LT$u64$u20$as$u20$bare..unknown..Unknown$GT$7unknown4WORD17hcd26ef447cc1a173E
.Lfunc_end0:
	.size	_start, .Lfunc_end0-_start
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_0,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_0,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_0:
.Lfunc_begin1:
	.fnstart
	.cfi_startproc
	vmov	r4, r6, d0
	mov	r2, r4
	mov	r3, r6
	b	__aeabi_ddiv
.Lfunc_end1:
	.size	OUTLINED_FUNCTION_0, .Lfunc_end1-OUTLINED_FUNCTION_0
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_1,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_1,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_1:
.Lfunc_begin2:
	.fnstart
	.cfi_startproc
	mov	r2, r4
	mov	r3, r6
	b	__aeabi_ddiv
.Lfunc_end2:
	.size	OUTLINED_FUNCTION_1, .Lfunc_end2-OUTLINED_FUNCTION_1
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_2,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_2,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_2:
.Lfunc_begin3:
	.fnstart
	.cfi_startproc
	movs	r1, #0
	movs	r5, #0
	b	__aeabi_ul2d
.Lfunc_end3:
	.size	OUTLINED_FUNCTION_2, .Lfunc_end3-OUTLINED_FUNCTION_2
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_3,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_3,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_3:
.Lfunc_begin4:
	.fnstart
	.cfi_startproc
	uxtb.w	r3, r11
	cmp	r3, #1
	mov	r11, r3
	bx	lr
.Lfunc_end4:
	.size	OUTLINED_FUNCTION_3, .Lfunc_end4-OUTLINED_FUNCTION_3
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_4,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_4,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_4:
.Lfunc_begin5:
	.fnstart
	.cfi_startproc
	mov	r11, r0
	rev.w	r0, r8
	mov	r10, r1
	movs	r1, #0
	b	__aeabi_ul2d
.Lfunc_end5:
	.size	OUTLINED_FUNCTION_4, .Lfunc_end5-OUTLINED_FUNCTION_4
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_5,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_5,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_5:
.Lfunc_begin6:
	.fnstart
	.cfi_startproc
	mov	r8, r0
	rev.w	r0, r11
	str	r1, [sp, #4]
	movs	r1, #0
	b	__aeabi_ul2d
.Lfunc_end6:
	.size	OUTLINED_FUNCTION_5, .Lfunc_end6-OUTLINED_FUNCTION_5
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_6,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_6,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_6:
.Lfunc_begin7:
	.fnstart
	.cfi_startproc
	rev.w	r2, r11
	rev.w	r6, r8
	lsrs	r5, r2, #16
	lsrs	r1, r2, #8
	mov.w	r10, #0
	bx	lr
.Lfunc_end7:
	.size	OUTLINED_FUNCTION_6, .Lfunc_end7-OUTLINED_FUNCTION_6
	.cfi_endproc
	.cantunwind
	.fnend

	.section	.text.OUTLINED_FUNCTION_7,"ax",%progbits
	.p2align	1
	.type	OUTLINED_FUNCTION_7,%function
	.code	16
	.thumb_func
OUTLINED_FUNCTION_7:
.Lfunc_begin8:
	.fnstart
	.cfi_startproc
	mov	r2, r6
	mov	r3, r8
	b	__aeabi_ddiv
.Lfunc_end8:
	.size	OUTLINED_FUNCTION_7, .Lfunc_end8-OUTLINED_FUNCTION_7
	.cfi_endproc
	.cantunwind
	.fnend

	.type	_ZN46_$LT$u64$u20$as$u20$bare..unknown..Unknown$GT$7unknown4WORD17hcd26ef447cc1a173E,%object
	.section	".rodata._ZN46_$LT$u64$u20$as$u20$bare..unknown..Unknown$GT$7unknown4WORD17hcd26ef447cc1a173E","a",%progbits
	.p2align	3, 0x0
_ZN46_$LT$u64$u20$as$u20$bare..unknown..Unknown$GT$7unknown4WORD17hcd26ef447cc1a173E:
	.zero	8
	.size	_ZN46_$LT$u64$u20$as$u20$bare..unknown..Unknown$GT$7unknown4WORD17hcd26ef447cc1a173E, 8

	.ident	"rustc version 1.95.0 (59807616e 2026-04-14)"
	.section	".note.GNU-stack","",%progbits
	.eabi_attribute	30, 4
